/// Plays a scenario on the simulated device as fast as it can, without page and recording.
///
/// Deterministic: cycle k is the same in every play of the same scenario. One player serves one
/// thread; several may play the same scenario at once.
#pragma once

#include <cstdint>
#include <memory>

#include "hg/config/scenario.h"
#include "hg/controller/cycle.h"
#include "hg/signals/state.h"
#include "hg/simulator/simulated_device.h"

namespace hg::studies {

/// Sets the seed of sensor errors, noise and tremor.
void set_seed(config::Scenario& scenario, std::uint64_t seed);

class Player {
 public:
  /// `scenario` needs a planned end (scenario::planned_duration_s) and must outlive the player.
  explicit Player(const config::Scenario& scenario);

  /// One period is begin(), run(), end(); run() is only Cycle::step.
  void begin();
  void run() noexcept {
    cycle_.step(sample_->sensors, sample_->operator_input, sample_->command, sample_->record);
  }
  /// Ends the period; false when it was the last one: the plan is over, or a fault stopped the
  /// device.
  bool end();

  const CycleRecord& record() const noexcept { return sample_->record; }
  /// Sample of this period, without the truth; valid between run() and end().
  const Sample& sample() const noexcept { return *sample_; }
  /// Sample of this period, with the truth; valid between run() and end().
  const Sample& judged_sample() noexcept {
    sample_->truth = truth();
    return *sample_;
  }
  /// True state at the time of the sensors; valid between begin() and end().
  const Truth& truth() const noexcept { return *device_.truth(); }
  /// Sensor values of the cycle, to inject faults: may be changed between begin() and run().
  SensorFrame& sensors() noexcept { return sample_->sensors; }
  /// Command to the device, to inject disturbances: may be changed between run() and end().
  CommandFrame& command() noexcept { return sample_->command; }
  bool is_running() const noexcept { return record().mode == Mode::kRunning; }
  controller::Cycle& cycle() noexcept { return cycle_; }

 private:
  const config::Scenario& scenario_;
  controller::Cycle cycle_;
  simulator::SimulatedDevice device_;
  TimedChanges changes_;
  double end_s_;
  std::uint64_t played_ = 0;
  std::unique_ptr<Sample> sample_ = std::make_unique<Sample>();
};

}  // namespace hg::studies
