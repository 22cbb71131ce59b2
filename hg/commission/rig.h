/// A machine whose joints are led one by one, without the control law: for its first motions.
///
/// Nothing moves unless a person holds a key, and the drives go off at once where a joint does not
/// do what it was commanded to. Sequential: each call takes as many periods as it needs.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hg/commission/stroke.h"
#include "hg/config/device.h"
#include "hg/controller/estimation/estimation.h"
#include "hg/controller/safety/sanitiser.h"
#include "hg/controller/tracking/joint_control.h"
#include "hg/device/device.h"
#include "hg/signals/sensor_check.h"

namespace hg::commission {

/// What a person is asked, answered with yes or no.
struct Question {
  std::string words;
  // what happened to the handle if the answer is yes, for a crew that is simulated:
  Eigen::Vector3d way = Eigen::Vector3d::Zero();   ///< in B, m
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< in B, rad
};

/// The person beside the machine, or one who is simulated. No call waits for anything.
class Crew {
 public:
  virtual ~Crew() = default;
  /// Whether the key is held without which nothing moves.
  virtual bool holds_key() = 0;
  virtual bool wants_to_end() = 0;
  virtual void say(double time_s, const std::string& words) = 0;
  virtual void ask(const Question& question) = 0;
  virtual std::optional<bool> answer() = 0;  ///< to the last question; empty: not yet
  /// Asks for a pull at the handle along `direction` of B; zero: let go.
  virtual void pull(const Eigen::Vector3d& direction) = 0;
  /// Acts on a simulated machine by the hand target and the panel of a command, which a real one
  /// ignores. `T_B_H`: where the handle really is, if it is known, else by the encoders.
  virtual void act(const Pose& /*T_B_H*/, CommandFrame& /*command*/) {}
};

/// Ends everything: the machine is gone or has a fault, or the person wants it so.
struct Ended {
  std::string why;
};

class Rig {
 public:
  /// All must outlive the rig. Throws SetupError where the device cannot be controlled.
  Rig(const config::DeviceConfig& config, device::Device& machine, Crew& crew);

  using Look = std::function<void(const SensorFrame&, const RobotState&)>;
  /// Waits with the drives off. Throws Ended, as all that follow.
  void rest(double duration_s, const Look& look = {});

  /// Switches the drives on while the key is held; they hold all joints and axes for a second.
  /// False: one of them left its place, the drives are off, and `moved` says by how much.
  bool power_on(VectorPM& moved);
  void power_off();
  /// Holds all joints for a while, with the drives on. Throws Ended, with the drives off, where one
  /// leaves its place.
  void hold(double duration_s);
  bool is_on() const { return was_on_; }

  /// Leads a joint by `way` (rad or m) while the drives are on and the key is held. A key that is
  /// let go of stops the motion, which continues with the key; after 20 s the drives go off.
  Stroke lead(int joint, double way);

  /// Sends nothing while the drives hold, as a controller that has died. Fault that then came from
  /// the machine; kNone: it still sent samples after `duration_s`, or a joint left its place or
  /// a person wanted the end before, and it got a last command.
  FaultCode fall_silent(double duration_s);

  const SensorFrame& sensors() const { return sensors_; }
  const RobotState& robot() const { return robot_; }
  /// Positions of gantry and manipulator, unwrapped.
  VectorPM positions() const { return stacked(robot_.q_p, robot_.q_m); }
  double dt() const { return config_.model.dt(); }
  const config::DeviceConfig& config() const { return config_; }
  Crew& crew() { return crew_; }

  static constexpr double kDuration = 2.0;  ///< of a stroke, s

 private:
  void exchange(bool is_on);
  void exchange_on();
  Pose handle();
  int astray(int joint) const;
  VectorPM reference() const { return stacked(q_p_reference_, now_.q_m); }

  const config::DeviceConfig& config_;
  device::Device& machine_;
  Crew& crew_;
  estimation::Estimation estimation_;
  estimation::EstimationState estimation_state_;
  tracking::JointControl control_;
  tracking::ControlState control_state_;
  safety::Sanitiser sanitiser_;
  model::ChainData chain_;
  RequiredSensors required_;
  SensorFrame sensors_;
  RobotState robot_;
  CommandFrame command_;
  ReferenceState now_, next_;  ///< references of this sample and of the next one
  VectorP dq_p_;               ///< gantry command
  VectorP q_p_reference_;
  bool was_on_ = false;
  std::uint64_t last_sequence_ = 0;  ///< 0: nothing was read yet
  double without_key_s_ = 0.0;       ///< with drives on
};

}  // namespace hg::commission
