/// A cycle, the simulated device of its scenario, and an operator who requests the run.
#pragma once

#include <cstdint>
#include <memory>

#include "hg/runtime/requests.h"
#include "hg/scenario/assembly.h"
#include "hg/signals/timed_changes.h"

namespace hg::python {

class Session {
 public:
  /// Throws SetupError.
  explicit Session(const config::Scenario& scenario)
      : cycle_(scenario::make_cycle(scenario)),
        device_(scenario::make_simulated_device(scenario)),
        changes_(scenario.changes),
        rate_Hz_(scenario.device.rate_Hz) {}

  /// Runs one period: read, step, write. A change planned by the scenario overrides a manual one.
  void step() noexcept {
    Sample& now = *sample_;
    now.operator_input = wishes_;
    wishes_.change = {};
    if (cycles_ > 0) {
      now.operator_input.request =
          runtime::next_request(now.record, cycle_.is_held(now.sensors), is_stopping_);
    }
    const ParameterChange due = changes_.due(static_cast<double>(cycles_++) / rate_Hz_);
    if (due.parameter != Parameter::kNone) now.operator_input.change = due;
    device_.read(now.sensors);
    now.truth = *device_.truth();
    cycle_.step(now.sensors, now.operator_input, now.command, now.record);
    device_.write(now.command);
  }

  /// Makes the operator request a stop from now on.
  void stop() noexcept { is_stopping_ = true; }

  /// Whether the session has ended: by a fault, or by a requested stop.
  bool is_over() const noexcept {
    const Mode mode = sample_->record.mode;
    return mode == Mode::kFault ||
           (is_stopping_ && mode != Mode::kRunning && mode != Mode::kStopping);
  }

  controller::Cycle& cycle() noexcept { return cycle_; }
  const Sample& sample() const noexcept { return *sample_; }
  /// Operator input of the next step(); requests are set by the session itself.
  OperatorFrame& wishes() noexcept { return wishes_; }

 private:
  controller::Cycle cycle_;
  simulator::SimulatedDevice device_;
  OperatorFrame wishes_;
  TimedChanges changes_;
  double rate_Hz_;
  std::uint64_t cycles_ = 0;
  std::unique_ptr<Sample> sample_ = std::make_unique<Sample>();
  bool is_stopping_ = false;
};

}  // namespace hg::python
