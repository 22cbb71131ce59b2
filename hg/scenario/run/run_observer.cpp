#include "hg/scenario/run/run_observer.h"

namespace hg::scenario {

std::string_view to_string(RunPhase phase) noexcept {
  switch (phase) {
    case RunPhase::kMoving:
      return "moving";
    case RunPhase::kOff:
      return "off";
    case RunPhase::kReady:
      return "ready";
    case RunPhase::kArmed:
      return "armed";
    case RunPhase::kRunning:
      return "running";
    case RunPhase::kStopping:
      return "stopping";
    case RunPhase::kFault:
      return "fault";
    case RunPhase::kOver:
      return "over";
  }
  return "";
}

RunPhase phase_of(Mode mode) noexcept {
  switch (mode) {
    case Mode::kOff:
      return RunPhase::kOff;
    case Mode::kReady:
      return RunPhase::kReady;
    case Mode::kArmed:
      return RunPhase::kArmed;
    case Mode::kRunning:
      return RunPhase::kRunning;
    case Mode::kStopping:
      return RunPhase::kStopping;
    case Mode::kFault:
      return RunPhase::kFault;
  }
  return RunPhase::kOff;
}

void RunObservers::link(const std::string& url) {
  for (RunObserver* each : all_) each->link(url);
}

void RunObservers::phase(RunPhase phase, double time_s, const std::string& wanted) {
  for (RunObserver* each : all_) each->phase(phase, time_s, wanted);
}

void RunObservers::sample(const Sample& sample) {
  for (RunObserver* each : all_) each->sample(sample);
}

void RunObservers::event(double time_s, std::string_view name, std::string_view text) {
  for (RunObserver* each : all_) each->event(time_s, name, text);
}

void RunObservers::status(const Sample& sample, const config::Scenario& scenario) {
  for (RunObserver* each : all_) each->status(sample, scenario);
}

void RunObservers::note(std::string_view label, const std::string& text) {
  for (RunObserver* each : all_) each->note(label, text);
}

void RunObservers::problem(const std::string& text) {
  for (RunObserver* each : all_) each->problem(text);
}

void RunObservers::fault(const RunFault& fault) {
  for (RunObserver* each : all_) each->fault(fault);
}

void RunObservers::summary(const RunSummary& summary) {
  for (RunObserver* each : all_) each->summary(summary);
}

}  // namespace hg::scenario
