/// Plays a scenario on the simulated device as fast as it can, without page and recording: a
/// session in three parts, so that an experiment can look at and change what passes between them.
///
/// Deterministic: cycle k is the same in every play of the same scenario. One player serves one
/// thread; several may play the same scenario at once.
#pragma once

#include <cstdint>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/cycle.h"
#include "hg/scenario/session.h"
#include "hg/signals/state.h"

namespace hg::experiments {

/// Sets the seed of sensor errors, noise and tremor.
void set_seed(config::Scenario& scenario, std::uint64_t seed);

class Player {
 public:
  /// `scenario` needs a planned end (scenario::planned_duration_s). Throws SetupError.
  explicit Player(const config::Scenario& scenario);

  /// One period is begin(), run(), end(); run() is only Cycle::step.
  void begin() { session_.read(); }
  void run() noexcept { session_.step(); }
  /// Ends the period; false when it was the last one: the plan is over, a fault stopped the device,
  /// or it stands still after stop().
  bool end();
  /// Requests an ordinary stop from the next period on, also after the end of the plan.
  void stop() noexcept;

  const CycleRecord& record() const noexcept { return session_.record(); }
  /// Sample of this period, with the truth; valid between run() and end().
  const Sample& sample() const noexcept { return session_.sample(); }
  /// True state at the time of the sensors; valid between begin() and end().
  const Truth& truth() const noexcept { return session_.sample().truth; }
  /// Sensor values of the cycle, to inject faults: may be changed between begin() and run().
  SensorFrame& sensors() noexcept { return session_.sample().sensors; }
  /// Command to the device, to inject disturbances: may be changed between run() and end().
  CommandFrame& command() noexcept { return session_.sample().command; }
  bool is_running() const noexcept { return record().mode == Mode::kRunning; }
  controller::Cycle& cycle() noexcept { return session_.cycle(); }

 private:
  scenario::Session session_;
  bool is_stopping_ = false;
};

}  // namespace hg::experiments
