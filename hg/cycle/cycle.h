/// One pass of the control loop: sensors and operator in, command and record out.
///
/// No clock, no thread, no I/O: the same inputs give the same bits. No allocation after
/// construction.
#pragma once

#include <vector>

#include "hg/collision/guard.h"
#include "hg/compliance/compliance.h"
#include "hg/control/joint_control.h"
#include "hg/core/nonblocking.h"
#include "hg/core/stage_probe.h"
#include "hg/environment/environment.h"
#include "hg/estimation/estimation.h"
#include "hg/passivity/passivity.h"
#include "hg/prepositioning/gantry_target.h"
#include "hg/prepositioning/prepositioning.h"
#include "hg/rendering/rendering.h"
#include "hg/safety/brakes.h"
#include "hg/safety/monitor.h"
#include "hg/safety/sanitiser.h"
#include "hg/safety/supervisor.h"
#include "hg/signals/state.h"

namespace hg::cycle {

/// Set-up data.
struct Config {
  estimation::Config estimation;
  prepositioning::Config prepositioning;
  rendering::Options rendering;
  control::Config control;
  safety::MonitorConfig monitor;
  safety::SanitiserConfig sanitiser;
  collision::Config collision;
  passivity::Config passivity;
  compliance::Config compliance;
  std::vector<environment::Surface> surfaces;  ///< that the twin meets
};

/// All that a cycle remembers. Copy it to take a snapshot, assign it to go back. What is added here
/// or below belongs into state_hash.cpp, too.
struct State {
  std::uint64_t cycle = 0;
  std::uint64_t next_sequence = 0;
  safety::SupervisorState supervisor;
  safety::MonitorState monitor;
  safety::BrakeState brakes;
  estimation::State estimation;
  rendering::State rendering;
  control::State control;
  prepositioning::TargetState gantry_target;
  collision::State collision;
  passivity::State passivity;
  compliance::State touch;
  Vector6 w_H = Vector6::Zero();  ///< of the user: the last one within the sensor's range
  VectorP dq_p;                   ///< gantry command of the last cycle
  prepositioning::Room room;      ///< of the gantry, in the last cycle
  VectorM q_m, tau_m;             ///< positions and torques of the last command
  bool was_on = false;            ///< the last command had the drives on
  bool is_blocked = false;        ///< a device limit could not be met in the last cycle
  bool brakes_joints = false;     ///< no solution, or a collision ahead: each brakes by itself
  bool is_coasting = false;       ///< joints or gantry moved in the last sample
  bool is_apart = false;          ///< the held twin cannot be where the handle is
  bool was_alone = false;         ///< ran autonomously when it last rendered without stopping
  double force_share = 0.0;       ///< of the forces that act on the twin, 0..1: come in by a ramp
};

class Cycle {
 public:
  /// Throws SetupError when the parts do not fit together.
  Cycle(const Config& config, const rendering::DeviceModel& device,
        const rendering::TwinModel& twin);

  void step(const SensorFrame& sensors, const OperatorFrame& operator_input, CommandFrame& command,
            CycleRecord& record) noexcept HG_NONBLOCKING;

  /// Whether somebody holds the handle, as far as the device can tell.
  bool is_held(const SensorFrame& sensors) const noexcept {
    return safety::is_held(monitor_.config(), sensors);
  }

  /// Who is told from now on how far a step has come; the default probe tells nobody.
  void watch(const StageProbe& probe) noexcept;

  const State& state() const noexcept { return state_; }
  void restore(const State& state) noexcept { state_ = state; }
  /// What the solver was given in the last step.
  const hqp::Problem& problem() const noexcept { return rendering_.problem(); }
  /// Solves that failed or were slow, see Rendering::kept_problems(). For one other thread.
  const hqp::KeptProblems& kept_problems() const noexcept { return rendering_.kept_problems(); }
  /// Keeps the last solve of the last step, too, which took that long; nothing when the step solved
  /// nothing: its sensor values were not finite.
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
  VectorM ddq_max_;   ///< of the joints, with which they brake by themselves
  int longest_stop_;  ///< cycles
  estimation::Estimation estimation_;
  rendering::Rendering rendering_;
  control::JointControl control_;
  prepositioning::GantryTarget gantry_target_;
  collision::Guard guard_;
  safety::Monitor monitor_;
  safety::Sanitiser sanitiser_;
  VectorM pulled_back_;  ///< this cycle: by how much the reference came back; empty = it did not
  State state_;
  StageProbe ended_;
};

}  // namespace hg::cycle
