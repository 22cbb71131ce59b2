/// From the reference of the manipulator to the commands of its drives.
///
/// Drives that follow a position get the reference itself. Series elastic joints get motor torques:
/// feedforward of everything the model knows (weight, inertia, gantry, user, friction, and the
/// twist of the springs that all this takes), and feedback that damps the modes of the arm; [C] 1,
/// where it is compared with others in closed loop. No allocation, noexcept after set-up.
#pragma once

#include <vector>

#include "hg/control/modes.h"
#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/model/chain.h"
#include "hg/signals/actuator_model.h"
#include "hg/signals/state.h"

namespace hg::control {

enum class Method {
  kDrives,   ///< the drives follow the reference by themselves
  kModal,    ///< full-state feedback in the modes of the arm
  kMotorPd,  ///< stiffness and damping on the motor side of each joint alone
};

/// Set-up data.
struct Config {
  double dt = 1e-3;  ///< period, s
  Method method = Method::kDrives;
  std::vector<ActuatorModel> actuators;  ///< one per manipulator joint; empty with kDrives
  TorqueLoop loop;                       ///< its latency is measured, this one is expected
  double latency_max = kInfinity;        ///< measured, with which the loop is known to be stable, s
  double integral_rate = 2.0;            ///< of kModal: error of the links goes with it, 1/s
  double integral_max = 5e-4;            ///< of the link error, rad s: no wind-up beyond
  double flatness_Hz = 40.0;             ///< low-pass of derivatives of feedforward torques
  double error_max = kInfinity;          ///< by which the reference may be ahead, rad or m
  double friction_share = 0.8;           ///< of the Coulomb friction that is fed forward, 0..1
  double friction_speed = 0.01;          ///< rad/s over which it changes its sign
  double friction_learning = 1.0;  ///< of kModal: rate at which the true friction is learnt, 1/s
};

/// Part of the copyable state of a cycle.
struct State {
  bool is_started = false;
  double latency = 0.0;  ///< mean of what was measured before the start, periods
  Poles poles;           ///< that the latency allows; chosen at the start
  Modes modes;
  VectorM integral;  ///< of q_r - q, rad s
  VectorM friction;  ///< what is fed forward over the Coulomb friction of the configuration
  VectorM tau_r, dtau_r, ddtau_r;  ///< feedforward torque of the links and its derivatives
  bool is_saturated = false;
};

class JointControl {
 public:
  /// `chain` holds the gantry joints first; `handle` is its frame H.
  /// Throws SetupError where numbers of actuators and joints differ.
  JointControl(const Config& config, const model::Chain& chain, int n_p, int n_m, int handle);

  State start() const;
  /// Drives are off: the next step begins anew. Learns the latency from the answered command.
  void rest(const ReferenceState& reference, const SensorFrame& sensors, State& state,
            CommandFrame& command) const noexcept;
  /// Whether the loop may be closed with the latency that was measured.
  bool is_stable(const State& state) const noexcept {
    return state.latency * config_.dt <= config_.latency_max;
  }
  /// Fills the manipulator part of `command`: `now` is the reference at the time of the sample,
  /// `next` where the drives should be a period later.
  void step(const ReferenceState& now, const ReferenceState& next, const RobotState& robot,
            State& state, CommandFrame& command, TrackingReport& report) noexcept;

 private:
  /// Reference minus measured, at the time of the sample.
  struct Errors {
    VectorM theta, dtheta, q, dq;
  };
  /// For the next period: torques of the springs, motion of the motors.
  struct Feedforward {
    VectorM tau, dtheta, ddtheta;
  };
  VectorM link_torque(const ReferenceState& reference, const RobotState& robot) noexcept;
  MatrixM scaled_mass() const noexcept;
  void begin(const ReferenceState& reference, const RobotState& robot, State& state) noexcept;
  Feedforward feedforward(const ReferenceState& reference, const RobotState& robot,
                          State& state) noexcept;
  void integrate(const VectorM& error, State& state) const noexcept;
  void follow_torque(const VectorM& tau, State& state) const noexcept;
  VectorM modal_torque(const Errors& errors, const RobotState& robot, const Feedforward& forward,
                       State& state) const noexcept;
  VectorM motor_pd_torque(const Errors& errors, const Feedforward& forward) const noexcept;
  VectorM friction(const Feedforward& forward, const State& state) const noexcept;
  void learn_friction(const Feedforward& forward, const VectorM& feedback, const RobotState& robot,
                      State& state) const noexcept;

  Config config_;
  model::Chain chain_;
  int n_p_, n_m_, handle_;
  VectorM K_, sqrt_K_, Jm_;
};

}  // namespace hg::control
