/// Runs a cycle on a device, one period after the other: no clock, no thread.
///
/// An automatic operator tares, arms and runs the device; see requests.h. No allocation after
/// construction, noexcept.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hg/core/nonblocking.h"
#include "hg/device/device.h"
#include "hg/signals/state.h"
#include "hg/signals/timed_changes.h"
#include "hg/signals/timed_load.h"
#include "hg/signals/twin_force_source.h"

namespace hg::controller {
class Cycle;
}

namespace hg::runtime {

/// What happens in a session at given times; set-up data.
struct SessionPlan {
  double duration_s = 0.0;           ///< Duration, s; 0 = until a fault or a stop
  std::vector<TimedChange> changes;  ///< Changes of the twin, in the order of their times
  std::vector<TimedLoad> load;       ///< Late cycles, for tests
  /// What pushes the twin, and outlives the session; nullptr = nothing.
  TwinForceSource* twin_force = nullptr;
  TwinBaseSource* twin_base = nullptr;  ///< The same of what moves the twin's root link
};

/// A cycle, its device and an operator.
class Session {
 public:
  /// `cycle` and `device` must outlive the session.
  Session(controller::Cycle& cycle, device::Device& device, const SessionPlan& plan = {});

  /// Runs one period: read(), step(), write(). False after the last one: a fault, standstill after
  /// stop(), or the end of the plan.
  bool advance() noexcept HG_NONBLOCKING;

  /// First part of a period: composes the operator input and reads the sensors. Both may be changed
  /// in sample() before step().
  void read() noexcept HG_NONBLOCKING;
  /// Second part of a period: only Cycle::step.
  void step() noexcept HG_NONBLOCKING;
  /// Last part of a period: sends the command.
  void write() noexcept HG_NONBLOCKING { device_.write(sample_->command); }

  /// Requests a mode, or nothing, in the next period only. From the first request on that takes
  /// over (takes_over()) none is made automatically, except after stop().
  void request(ModeRequest request) noexcept;
  /// Requests a stop from the next period on, and no further run.
  void stop() noexcept { is_stopping_ = true; }
  /// Whether the session has ended: by a fault, or at rest after stop().
  bool is_over() const noexcept;
  /// Whether the planned duration has passed.
  bool has_played() const noexcept { return duration_s_ > 0.0 && record().time_s >= duration_s_; }

  /// Operator input of the next period: hand target and panel stay, a change and late cycles count
  /// once. A change waits while a planned one is due.
  OperatorFrame& input() noexcept { return next_; }
  /// Data of the last period: sensors, operator input, command, record, and the truth where the
  /// device provides it.
  Sample& sample() noexcept { return *sample_; }
  const Sample& sample() const noexcept { return *sample_; }
  const CycleRecord& record() const noexcept { return sample_->record; }
  controller::Cycle& cycle() noexcept { return cycle_; }
  const controller::Cycle& cycle() const noexcept { return cycle_; }
  device::Device& device() noexcept { return device_; }

 private:
  controller::Cycle& cycle_;
  device::Device& device_;
  double duration_s_;
  TimedChanges changes_;
  TimedLoads loads_;
  TwinForceSource* twin_force_;
  TwinBaseSource* twin_base_;
  OperatorFrame next_;
  bool is_operated_ = false;  ///< Requests come from the caller
  bool is_asked_ = false;     ///< The next period has a request from outside, or none on purpose
  bool is_stopping_ = false;
  std::unique_ptr<Sample> sample_ = std::make_unique<Sample>();
};

}  // namespace hg::runtime
