/// The stages of the control cycle, their order, and what they leave to the next cycle.
#pragma once

#include <cstdint>

#include "hg/controller/cycle_config.h"
#include "hg/controller/cycle_state.h"
#include "hg/controller/estimation/estimation.h"
#include "hg/controller/prepositioning/gantry_target.h"
#include "hg/controller/prepositioning/prepositioning.h"
#include "hg/controller/rendering/rendering.h"
#include "hg/controller/rendering/surfaces/environment.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/controller/safety/compliance/compliance.h"
#include "hg/controller/safety/monitor.h"
#include "hg/controller/safety/passivity/passivity.h"
#include "hg/controller/safety/sanitiser.h"
#include "hg/controller/safety/supervisor.h"
#include "hg/controller/tracking/joint_control.h"
#include "hg/core/nonblocking.h"
#include "hg/core/stage_probe.h"
#include "hg/signals/sensor_check.h"
#include "hg/signals/state.h"

namespace hg::controller {

/// What Cycle does, with all its parts.
class CycleStages {
 public:
  CycleStages(const CycleConfig& config, const DeviceModel& device,
              const rendering::TwinModel& twin);

  // as Cycle
  void step(const SensorFrame& sensors, const OperatorFrame& operator_input, CommandFrame& command,
            CycleRecord& record) noexcept HG_NONBLOCKING;
  bool is_held(const SensorFrame& sensors) const noexcept {
    return safety::is_held(monitor_.config(), sensors);
  }
  double time_s() const noexcept { return static_cast<double>(state_.cycle) * dt_; }
  void watch(const StageProbe& probe) noexcept;
  const CycleState& state() const noexcept { return state_; }
  void restore(const CycleState& state) noexcept { state_ = state; }
  const rendering::Rendering& rendering() const noexcept { return rendering_; }
  void keep_problem(double cycle_time_us) noexcept {
    rendering_.keep_problem(state_.cycle - 1, cycle_time_us);
  }

 private:
  /// Result of the supervisor.
  struct Supervision {
    bool is_usable = false;  ///< The sample has all values, and they are finite
    Refusal refusal = Refusal::kNone;
    ChangeStatus change = ChangeStatus::kNone;
    const TwinForce* twin_force = nullptr;  ///< Where there is one that can be used
  };
  /// Aim of the gantry. Empty where the device does not move.
  struct GantryAim {
    prepositioning::GantryCommand command;
    GantryTask task;  ///< Empty where the law does not lead the gantry
  };
  /// Motion from this sample to the next. Empty without a usable sample.
  struct Moved {
    ReferenceState reference;  ///< Reference at the time of the sample, and its accelerations
    TwinState twin;            ///< Twin at the time of the sample, and its accelerations
    double sync_error = 0.0;   ///< Distance of handle and twin, m; 0 where the twin does not follow
    VectorP dq_p;              ///< Velocity command of the gantry, m/s or rad/s
  };
  /// Results of the stages from the supervisor to the rendering.
  struct Results {
    const Supervision& supervision;
    const RobotState& robot;
    const CollisionReport& collision;
    Motion motion;
    const VectorM& pulled_back;  ///< Shift of the reference back to the device; empty = none
    const GantryAim& gantry;
    const rendering::LawResult& law;
    const PassivityReport& passivity;
    const Moved& moved;
  };

  // stages, in the order of their calls
  Supervision supervise(const SensorFrame& sensors, const OperatorFrame& operator_input) noexcept;
  RobotState estimate(const SensorFrame& sensors) noexcept;
  collision::Prediction look_ahead(const SensorFrame& sensors, const RobotState& robot) noexcept;
  CollisionTask keep_apart(Motion motion, const RobotState& robot) noexcept;
  Motion decide(bool is_usable, bool must_brake) const noexcept;
  VectorM place_reference(Motion motion, const RobotState& robot) noexcept;
  GantryAim preposition(Motion motion, const RobotState& robot) noexcept;
  const rendering::LawResult& render(Motion motion, bool is_held, const RobotState& robot,
                                     const GantryAim& gantry, const TwinForce* twin_force) noexcept;
  PassivityReport watch_energy(Motion motion, const RobotState& robot,
                               const rendering::LawResult& law) noexcept;
  void watch_rest(Motion motion, const RobotState& robot, const rendering::LawResult& law) noexcept;
  Moved advance(Motion motion, const RobotState& robot, const GantryAim& gantry,
                const rendering::LawResult& law) noexcept;
  void time_stop(Motion motion, const RobotState& robot, const Moved& moved) noexcept;
  Fault monitor(const SensorFrame& sensors, std::uint32_t late_cycles,
                const Results& results) noexcept;
  TrackingReport control(const RobotState& robot, const Moved& moved,
                         CommandFrame& command) noexcept;
  TouchReport feel_touch(bool is_on, const RobotState& robot) noexcept;
  std::uint32_t sanitise(const RobotState& robot, CommandFrame& command) noexcept;
  void remember(std::uint64_t sequence, const CommandFrame& command) noexcept;
  void fill(const Results& results, const Fault& warning, const TrackingReport& tracking,
            const TouchReport& touch, std::uint32_t sanitised, CycleRecord& record) const noexcept;

  // parts of these stages
  Fault check(const SensorFrame& sensors, const Fault& values) noexcept;
  Fault check(const TwinForce& force) const noexcept;
  Fault check(const TwinBase& base) const noexcept;
  Refusal refusal_to_arm() const noexcept;
  void reset_controllers() noexcept;
  double speed_max() const noexcept;
  double ramp_out() const noexcept;
  double ramp_forces(Motion motion, bool is_held, double fade_s) noexcept;
  Motion accept(Motion motion, const rendering::LawResult& law) noexcept;
  void brake_joints(const RobotState& robot) noexcept;

  CycleConfig config_;
  RequiredSensors required_;
  double dt_;           ///< Period, s
  VectorM torque_max_;  ///< Peak torque of each joint, Nm; empty without torque control
  estimation::Estimation estimation_;
  rendering::Rendering rendering_;
  tracking::JointControl control_;
  prepositioning::GantryTarget gantry_target_;
  prepositioning::Prepositioning prepositioning_;
  collision::Braking braking_;  ///< Of joints that brake without the law
  collision::Guard guard_;
  safety::Monitor monitor_;
  safety::Sanitiser sanitiser_;
  rendering::LawResult law_;  ///< Result of the law in this cycle; a member because of its size
  CycleState state_;
  StageProbe ended_;
};

}  // namespace hg::controller
