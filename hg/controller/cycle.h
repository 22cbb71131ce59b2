/// One pass of the control loop: sensors and operator in, command and record out.
///
/// No clock, no thread, no I/O: the same inputs give the same bits. No allocation after
/// construction.
#pragma once

#include <vector>

#include "hg/controller/estimation/estimation.h"
#include "hg/controller/prepositioning/gantry_target.h"
#include "hg/controller/prepositioning/prepositioning.h"
#include "hg/controller/rendering/rendering.h"
#include "hg/controller/rendering/surfaces/environment.h"
#include "hg/controller/safety/brakes.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/controller/safety/compliance/compliance.h"
#include "hg/controller/safety/monitor.h"
#include "hg/controller/safety/passivity/passivity.h"
#include "hg/controller/safety/sanitiser.h"
#include "hg/controller/safety/supervisor.h"
#include "hg/controller/tracking/joint_control.h"
#include "hg/core/nonblocking.h"
#include "hg/core/stage_probe.h"
#include "hg/signals/state.h"

namespace hg::controller {

/// Set-up data.
struct Config {
  estimation::Config estimation;
  prepositioning::Config prepositioning;
  rendering::Options rendering;
  tracking::Config control;
  safety::MonitorConfig monitor;
  safety::SanitiserConfig sanitiser;
  collision::Config collision;
  passivity::Config passivity;
  compliance::Config compliance;
  std::vector<surfaces::Surface> surfaces;  ///< Virtual surfaces in contact with the twin
};

/// Complete state of a cycle. Copy it for a snapshot, assign it to restore. Members added here or
/// in nested states must be added to state_hash.cpp, too.
struct State {
  std::uint64_t cycle = 0;
  std::uint64_t next_sequence = 0;
  safety::SupervisorState supervisor;
  safety::MonitorState monitor;
  safety::BrakeState brakes;
  estimation::State estimation;
  rendering::State rendering;
  tracking::State control;
  prepositioning::TargetState gantry_target;
  collision::State collision;
  passivity::State passivity;
  compliance::State touch;
  Vector6 w_H = Vector6::Zero();  ///< Wrench of the user, the last one within the sensor's range
  VectorP dq_p;                   ///< Gantry command of the last cycle
  prepositioning::Room room;      ///< Room of the gantry in the last cycle
  VectorM q_m, tau_m;             ///< Positions and torques of the last command
  bool was_on = false;            ///< The last command had the drives on
  bool is_blocked = false;        ///< A device limit could not be met in the last cycle
  bool brakes_joints = false;     ///< No solution, or a collision ahead: joints brake one by one
  bool is_coasting = false;       ///< Joints or gantry moved in the last sample
  bool is_apart = false;          ///< The twin cannot reach the handle's pose while held
  bool was_alone = false;         ///< Last rendering without stopping was autonomous
  double force_share = 0.0;       ///< Ramped share of the forces on the twin, 0..1
};

/// The control cycle with all its parts.
class Cycle {
 public:
  /// Builds all parts. Throws SetupError if they do not fit together.
  Cycle(const Config& config, const rendering::DeviceModel& device,
        const rendering::TwinModel& twin);

  /// Runs one cycle: computes `command` and `record` from sensors and operator input.
  void step(const SensorFrame& sensors, const OperatorFrame& operator_input, CommandFrame& command,
            CycleRecord& record) noexcept HG_NONBLOCKING;

  /// Whether the handle is held, as far as the device can detect.
  bool is_held(const SensorFrame& sensors) const noexcept {
    return safety::is_held(monitor_.config(), sensors);
  }

  /// Installs a callback per stage; the default probe does nothing.
  void watch(const StageProbe& probe) noexcept;

  const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept { state_ = state; }
  /// Problem that the solver received in the last step.
  const hqp::Problem& problem() const noexcept { return rendering_.problem(); }
  /// Problems of failed or slow solves, see Rendering::kept_problems(). May be read by one other
  /// thread.
  const hqp::ProblemCapture& kept_problems() const noexcept { return rendering_.kept_problems(); }
  /// Keeps the last solve of the last step, too, with the cycle's duration; no effect if the step
  /// had no solve because sensor values were not finite.
  void keep_problem(double cycle_time_us) noexcept {
    rendering_.keep_problem(state_.cycle - 1, cycle_time_us);
  }

 private:
  void supervise(const SensorFrame& sensors, const OperatorFrame& operator_input,
                 CycleRecord& record) noexcept;
  Fault check(const SensorFrame& sensors) noexcept;
  Refusal refusal_to_arm() const noexcept;
  void begin_anew() noexcept;
  void trust_wrench(const SensorFrame& sensors, RobotState& robot) noexcept;
  void look_ahead(CycleRecord& record) noexcept;
  void watch_energy(CycleRecord& record) noexcept;
  void feel_touch(bool is_on, CycleRecord& record) noexcept;
  void hold(CycleRecord& record) noexcept;
  void render(bool is_held, CycleRecord& record) noexcept;
  void monitor(const SensorFrame& sensors, std::uint32_t late_cycles, CycleRecord& record) noexcept;
  void sanitise(CommandFrame& command, CycleRecord& record) noexcept;
  void brake_joints(CycleRecord& record) noexcept;
  void write_command(const SensorFrame& sensors, const OperatorFrame& operator_input,
                     CommandFrame& command, CycleRecord& record) noexcept;

  Config config_;
  VectorM ddq_max_;   ///< Deceleration of joints that brake without the law, rad/s^2 or m/s^2
  int longest_stop_;  ///< Longest controlled stop, cycles
  estimation::Estimation estimation_;
  rendering::Rendering rendering_;
  tracking::JointControl control_;
  prepositioning::GantryTarget gantry_target_;
  collision::Guard guard_;
  safety::Monitor monitor_;
  safety::Sanitiser sanitiser_;
  VectorM pulled_back_;  ///< Shift of the reference back to the device; empty = none
  State state_;
  StageProbe ended_;
};

}  // namespace hg::controller
