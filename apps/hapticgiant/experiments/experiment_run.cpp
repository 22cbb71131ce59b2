#include "apps/hapticgiant/experiments/experiment_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <limits>
#include <thread>

#include "apps/hapticgiant/experiments/condition_text.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/run_recording.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/version.h"
#include "hg/analysis/summary.h"
#include "hg/recording/recorder.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/assembly.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds kIdle(2);

// keys of a summary that are the same whenever the same run is made again
constexpr std::array kReproducible = {"scenario",
                                      "version",
                                      "law",
                                      "bounds",
                                      "gantry",
                                      "braking",
                                      "rate_Hz",
                                      "duration_s",
                                      "cycles",
                                      "events",
                                      "missing_events",
                                      "limits",
                                      "limits_held",
                                      "reality",
                                      "sync_error",
                                      "force",
                                      "solver",
                                      "acceleration_change_per_cycle",
                                      "state_hash",
                                      "allocations_in_loop",
                                      "fault"};

// The recorder of an experiment, whose file says nothing of the wall clock.
std::unique_ptr<recording::Recorder> make_recorder(const config::Scenario& scenario,
                                                   const RunArguments& arguments) {
  if (!recording::recording_available()) {
    print_out(kNoRecording);
    return nullptr;
  }
  recording::RecordingInfo info = recording_info(scenario, arguments);
  info.start = {};
  info.is_reproducible = true;
  return std::make_unique<recording::Recorder>(info);
}

// renames the recording to the usual name in its own folder
void settle(recording::Recorder& recorder, const fs::path& folder, ExperimentResult& result) {
  const recording::RecordingSummary recorded = recorder.close();
  std::error_code error, ignored;
  const fs::path link = folder / "latest.mcap";
  if (fs::is_symlink(link, ignored)) fs::remove(link, ignored);
  fs::rename(recorded.file, folder / "recording.mcap", error);
  for (const std::string& why : {recorded.error, error ? error.message() : std::string()}) {
    if (!why.empty()) result.failures.push_back("recording.mcap: " + why);
  }
}

std::vector<EventResult> expected_events(const PaperExperiment& experiment,
                                         const config::Scenario& scenario) {
  std::vector<EventResult> events;
  const double start_s = scenario.script.script.grasp_s;
  for (const EventRule& rule : scenario.events) {
    EventResult& event = events.emplace_back(EventResult{.rule = &rule});
    for (const EventWindow& window : experiment.windows) {
      if (window.event != rule.name) continue;
      event.window = &window;
      event.window_from_s = start_s + window.from_s;
      event.window_to_s = start_s + window.to_s;
    }
  }
  return events;
}

void add_failures(const analysis::Summary& summary, ExperimentResult& result) {
  for (const EventResult& event : result.events) {
    if (!event.found_s) {
      result.failures.push_back(
          fmt::format("{} did not happen: {}", event.rule->name, event.rule->what));
    } else if (!event.is_as_expected()) {
      result.failures.push_back(fmt::format(
          "{} happened at {:.3f} s, expected {:.1f} .. {:.1f} s: {}", event.rule->name,
          *event.found_s, event.window_from_s, event.window_to_s, event.window->because));
    }
  }
  if (!summary.limits_held()) result.failures.push_back("a limit was exceeded, see the table");
  result.has_fault = summary.fault().code != FaultCode::kNone;
  if (result.has_fault) {
    result.failures.push_back(fmt::format("fault {}: {}", static_cast<int>(summary.fault().code),
                                          to_string(summary.fault().code)));
  }
}

// parts what a second run repeats from what it does not
void split(const std::string& summary, ExperimentResult& result) {
  const Json all = Json::parse(summary);
  for (const auto& [key, value] : all.items()) {
    const bool is_same = std::ranges::find(kReproducible, key) != kReproducible.end();
    (is_same ? result.summary : result.timing)[key] = value;
  }
  result.timing.erase("recording");
}

/// All observers of the samples of one experiment.
struct Watcher {
  ExperimentResult& result;
  analysis::EventDetector detector;
  analysis::Summary summary;
  std::unique_ptr<recording::Recorder> recorder;

  void look_at(Sample& sample) {
    summary.add(sample);
    if (const auto event = detector.observe(sample.record)) {
      summary.add(*event);
      for (EventResult& expected : result.events) {
        if (expected.rule->name == event->name) expected.found_s = event->time_s;
      }
      if (recorder) recorder->event(event->time_s, event->name, event->what);
    }
    result.table->add(sample);
    sample.cycle_time_us = 0.0;  // differs from run to run
    if (recorder) recorder->push_waiting(sample);
  }
};

}  // namespace

std::vector<Mark> ExperimentResult::marks() const {
  std::vector<Mark> marks;
  for (const EventResult& event : events) {
    if (event.found_s)
      marks.push_back({paper_label(*event.rule), *event.found_s, event.rule->what});
  }
  return marks;
}

double ExperimentResult::time_of(std::string_view name) const {
  for (const EventResult& event : events) {
    if (event.rule->name == name && event.found_s) return *event.found_s;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

ExperimentResult run_experiment(const PaperExperiment& experiment, const RunArguments& arguments,
                                const SimulatedTime& progress) {
  ExperimentResult result;
  result.experiment = &experiment;
  result.scenario = std::make_unique<config::Scenario>(make_scenario(arguments));
  const config::Scenario& scenario = *result.scenario;
  result.table = std::make_unique<RunTable>(scenario);
  result.events = expected_events(experiment, scenario);

  runtime::RuntimeOptions options;
  options.rate_Hz = scenario.device.rate_Hz;
  options.is_fast = true;
  options.duration_s = arguments.duration_s.value_or(scenario::planned_duration_s(scenario));
  options.longest_stop_s = scenario::longest_stop_s(scenario);
  options.changes = scenario.changes;
  options.load = faults::loads_of(scenario.faults);
  runtime::check_runtime_options(options);
  controller::Cycle cycle = scenario::make_cycle(scenario);
  const auto device = scenario::make_simulated_device(scenario);
  runtime::Runtime runtime(options, cycle, *device);
  Watcher watcher{result,
                  {scenario.events, scenario.limits},
                  scenario::make_summary(scenario),
                  make_recorder(scenario, arguments)};

  const auto begin = std::chrono::steady_clock::now();
  const auto sample = std::make_unique<Sample>();
  runtime.start();
  for (bool is_finished = false; !is_finished;) {
    is_finished = runtime.is_finished();
    while (runtime.pop(*sample)) watcher.look_at(*sample);
    progress(sample->record.time_s, options.duration_s);
    if (!is_finished) std::this_thread::sleep_for(kIdle);
  }
  const runtime::RuntimeReport report = runtime.join();
  if (watcher.recorder) settle(*watcher.recorder, arguments.recordings, result);

  analysis::RunFacts facts = scenario::facts_of_scenario(scenario);
  facts.version = kVersion;
  facts.rate_Hz = options.rate_Hz;
  facts.allocations_in_loop = report.allocations;
  facts.timing.is_fast = true;
  facts.wall_time_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  split(watcher.summary.to_json(facts, watcher.detector.missing()), result);
  result.summary["seed"] = scenario.device.simulation.seed;
  add_failures(watcher.summary, result);
  return result;
}

}  // namespace hg::apps
