/// Control of the manipulator joints: from the reference to the commands of the drives.
///
/// Drives that follow a position get the reference itself. Series elastic joints get motor torques:
/// feedforward of everything in the model (weight, inertia, gantry, user, friction, and the
/// twist of the springs that all this takes), and feedback that damps the modes of the arm; [C] 1,
/// where it is compared with others in closed loop. No allocation, noexcept after set-up.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/controller/tracking/control_config.h"
#include "hg/controller/tracking/control_state.h"
#include "hg/controller/tracking/modes.h"
#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"
#include "hg/signals/presliding.h"
#include "hg/signals/state.h"

namespace hg::tracking {

inline constexpr int kAnswersNeeded = 100;  ///< samples until the latency counts as known
/// Largest factor on the friction of the configuration; more would be another fault.
inline constexpr double kMostFriction = 2.0;

class JointControl {
 public:
  /// Throws SetupError where a torque loop has no actuators, and what check_control_config()
  /// throws.
  JointControl(const ControlConfig& config, const DeviceModel& device);

  ControlState start() const noexcept;
  /// Resets the state after a fault, except for the measured latency.
  void restart(ControlState& state) const noexcept;
  /// Evaluates the age of the command at work; call once per sample, with drives `on` or off. Off,
  /// the latency is learnt from it; on, it is monitored.
  void listen(const SensorFrame& sensors, bool on, ControlState& state) const noexcept;
  /// Whether enough commands were answered to determine the latency, or there is no torque loop.
  bool is_latency_known(const ControlState& state) const noexcept {
    return config_.method == Method::kDrives || state.answers >= kAnswersNeeded;
  }
  /// Whether the loop is stable with the measured latency; true without a torque loop.
  bool is_stable(const ControlState& state) const noexcept {
    return config_.method == Method::kDrives || state.latency * dt_ <= config_.latency_max;
  }
  /// kCommandsLost once none has arrived for 10 ms (2.5 periods), from any device that answers.
  /// With a torque loop also kCommandsLost or kLatencyGrew once the samples with a command more
  /// than half a period older than the latency assumed by the gains outnumber the others by 50 ms.
  /// kNone otherwise.
  Fault check_latency(const SensorFrame& sensors, const ControlState& state) const noexcept;
  /// Like check_latency(), but from 5 ms on and for any device that answers: enough to explain why
  /// the device does not move as commanded.
  Fault link_disturbance(const SensorFrame& sensors, const ControlState& state) const noexcept;
  /// Fills `command` while the drives are off and resets the control for the next step().
  void rest(const ReferenceState& reference, ControlState& state,
            CommandFrame& command) const noexcept;
  /// Prepares `state` for the first step() after start(), restart() or rest(), which otherwise does
  /// so itself.
  void begin(const ReferenceState& reference, const RobotState& robot,
             ControlState& state) noexcept;
  /// Fills the manipulator part of `command`: `now` is the reference at the time of the sample,
  /// `next` where the drives should be a period later.
  void step(const ReferenceState& now, const ReferenceState& next, const RobotState& robot,
            ControlState& state, CommandFrame& command, TrackingReport& report) noexcept;

  /// Torques on the joints, Nm.
  struct JointTorques {
    VectorM external;  ///< Torques explained by neither motion nor user: contact of the arm
    VectorM motion;    ///< Model torques that move and hold the joints, and the user's
  };
  /// Joint torques in the last step(), with the measured acceleration `ddq` of the links instead of
  /// that of the reference. Only with torque control.
  JointTorques joint_torques(const RobotState& robot, const VectorM& ddq) const noexcept;

 private:
  /// Reference minus measured, at the time of the sample.
  struct Errors {
    VectorM theta, dtheta, q, dq;
  };
  /// For the next period: torques of the springs, motion of the motors.
  struct Feedforward {
    VectorM tau, dtheta, ddtheta;
    VectorM dry, along;  ///< dry friction: at most, Nm, and the share of that, -1..1
  };
  Fault link_fault(const SensorFrame& sensors, const ControlState& state) const noexcept;
  VectorM link_torque(const ReferenceState& reference, const RobotState& robot) noexcept;
  VectorM fed(const VectorM& tau) const noexcept {
    return tau.cwiseMin(feed_max_).cwiseMax(-feed_max_);
  }
  MatrixM scaled_mass() const noexcept;
  VectorM stiffness_shares(const ControlState& state) const noexcept;
  VectorM of_modes(const VectorM& in_modes, const ControlState& state) const noexcept;
  VectorM of_stiff_modes(const VectorM& tau, const VectorM& shares,
                         const ControlState& state) const noexcept;
  VectorM timely(const VectorM& tau, const RobotState& robot, ControlState& state) const noexcept;
  Feedforward feedforward(const ReferenceState& reference, const RobotState& robot,
                          ControlState& state) noexcept;
  void integrate(const VectorM& error, ControlState& state) const noexcept;
  void follow_torque(const VectorM& tau, ControlState& state) const noexcept;
  VectorM modal_torque(const Errors& errors, const RobotState& robot, const Feedforward& forward,
                       ControlState& state) const noexcept;
  VectorM motor_pd_torque(const Errors& errors, const Feedforward& forward) const noexcept;
  void dry_friction(const ReferenceState& reference, ControlState& state,
                    Feedforward& forward) const noexcept;
  VectorM friction(const Feedforward& forward, const ControlState& state) const noexcept;
  void learn_friction(const Feedforward& forward, const VectorM& feedback, const RobotState& robot,
                      ControlState& state) const noexcept;

  ControlConfig config_;
  model::ChainData chain_;
  int n_p_, n_m_, handle_;
  double dt_;                                  ///< Period, s
  std::vector<ActuatorModel> actuators_;       ///< Actuators, one per joint
  double lead_pole_ = 0.0, stiff_pole_ = 0.0;  ///< Poles of the low-passes
  VectorM K_, sqrt_K_, J_m_;
  bool has_feet_ = false;        ///< Some joint has presliding
  VectorM feed_max_;             ///< Largest torque that is fed forward, Nm
  VectorM link_torque_, ddq_r_;  ///< Result of link_torque() in this step, and its ddq
};

}  // namespace hg::tracking
