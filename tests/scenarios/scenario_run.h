/// Plays a scenario without threads: the same cycle and simulated device as the program, in a loop.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/hapticgiant/run_setup.h"
#include "hg/evaluation/events.h"
#include "hg/evaluation/summary.h"

namespace hg {

class ScenarioRun {
 public:
  explicit ScenarioRun(const std::string& name)
      : ScenarioRun(apps::RunArguments{.scenario = name}) {}

  explicit ScenarioRun(const apps::RunArguments& arguments)
      : scenario_(apps::make_scenario(arguments)),
        cycle_(apps::make_cycle(scenario_)),
        device_(apps::make_simulated_device(scenario_)),
        detector_(scenario_.events, scenario_.limits),
        summary_(scenario_.limits) {}

  /// Plays until the script has played, or `seconds` of it; `look` sees every sample.
  void play(const std::function<void(const Sample&)>& look = {}, double seconds = 1e9) {
    auto sample = std::make_unique<Sample>();
    const double end = std::min(seconds, apps::planned_duration_s(scenario_));
    do {
      device_.read(sample->sensors);
      cycle_.step(sample->sensors, sample->operator_input, sample->command, sample->record);
      device_.write(sample->command);
      sample->operator_input.request = sample->record.mode == Mode::kReady   ? ModeRequest::kArm
                                       : sample->record.mode == Mode::kArmed ? ModeRequest::kRun
                                                                             : ModeRequest::kNone;
      summary_.add(*sample);
      if (const auto event = detector_.observe(sample->record)) summary_.add(*event);
      if (look) look(*sample);
    } while (sample->record.time_s < end && sample->record.mode != Mode::kFault);
  }

  const config::Scenario& scenario() const { return scenario_; }
  const evaluation::Summary& summary() const { return summary_; }
  std::vector<std::string> missing() const { return detector_.missing(); }

  /// Time of an event; -1 if it did not happen.
  double time_of(const std::string& name) const {
    for (const evaluation::Event& event : summary_.events()) {
      if (event.name == name) return event.time_s;
    }
    return -1.0;
  }

  /// Index of a limit in the catalogue; -1 if there is none of that name.
  int limit(const std::string& name) const {
    for (std::size_t i = 0; i < scenario_.limits.size(); ++i) {
      if (scenario_.limits[i].name == name) return static_cast<int>(i);
    }
    return -1;
  }

 private:
  config::Scenario scenario_;
  cycle::Cycle cycle_;
  device::SimulatedDevice device_;
  evaluation::EventDetector detector_;
  evaluation::Summary summary_;
};

}  // namespace hg
