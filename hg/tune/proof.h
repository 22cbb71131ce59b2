/// Robust stability of a torque loop against unknown properties of the arm and of the hand.
#pragma once

#include <string>
#include <vector>

#include "hg/handle_loop/handle_loop.h"

namespace hg::tune {

using handle_loop::Body;
using handle_loop::linearise;
using handle_loop::LoopDevice;

/// A deviation from the controller's model.
struct Deviation {
  std::string what;  ///< description, e.g. "springs x 0.75"
  tracking::TruePlant plant;
  double follower = 1.0;  ///< factor of flatness_Hz
  double mass = 1.0;      ///< factor of the lightest bodies
  double fed = -1.0;      ///< factor of presliding friction that is fed forward; < 0 = none
};

/// Deviations without a hand: none; rotors, springs and links of 0.75 and 1.25 times the nominal
/// value; each separately, as in deviations_in_hand().
std::vector<Deviation> deviations(const tracking::Loop& nominal);

/// Deviations in a hand: none; 1.5 times the latency; torques that follow half as fast. The last
/// occurs when motors are at their peak (follow_torque() in tracking/joint_control.cpp) and can
/// make a stable hand oscillate for ever.
std::vector<Deviation> deviations_in_hand(const tracking::Loop& nominal);

/// Deviations in joints with presliding: the friction has not slipped, with a stiffness of 0.5, 1
/// and 1.25 times the nominal one; the feedforward is 0.5 to 1.25 times as stiff as the friction.
/// In hands, with the body itself. Empty for a device without presliding.
std::vector<Deviation> deviations_in_friction(const tracking::Loop& nominal);

/// A hand that holds the handle of a body.
struct Grasp {
  std::string what;  ///< description, e.g. "stiff hand"
  person::HandImpedance hand;
  Body body;
};

/// The hands of [HANDBOOK] 5.1 and arms on lightly damped springs of 300 to 2000 N/m, with bodies
/// so light (no heavier than `body`) that little stability margin remains.
std::vector<Grasp> grasps(const Body& body);

/// A case that a loop must tolerate in one posture: one of deviations() without a hand; with a
/// hand, one of deviations_in_hand() or, after them, of deviations_in_friction().
struct Case {
  std::size_t posture = 0, deviation = 0;
  int grasp = -1;  ///< index of the grasp; -1 = without a hand

  bool operator==(const Case&) const = default;
};

/// Radius per millisecond: errors fall to 37 % in 0.2 s
inline constexpr double kArmRadius = 0.995;
/// Radius per millisecond: to 37 % in 2.5 s, as a hand's own slow motions count
inline constexpr double kHandRadius = 0.9996;
/// Radius with sticking friction, where decay is slow: small motions only have to decay.
inline constexpr double kFrictionRadius = 1.0;

/// All cases that a torque loop must tolerate.
class Demands {
 public:
  Demands(const tracking::Loop& nominal, const Body& body, std::vector<Eigen::VectorXd> postures);

  const std::vector<Eigen::VectorXd>& postures() const { return postures_; }
  /// Whether the case is one of deviations_in_friction().
  bool is_friction(const Case& one) const { return deviation(one).fed >= 0.0; }
  /// All cases of a posture.
  std::vector<Case> cases(std::size_t posture) const;
  /// Largest modulus of the eigenvalues of `device`, per millisecond.
  double radius(const LoopDevice& device, const Case& one) const;
  /// Excess of the radius over its limit; > 0 where motions do not decay in time.
  double excess(const LoopDevice& device, const Case& one) const;
  /// Name of a case, e.g. "stiff hand, 0.4 kg, latency x 1.5".
  std::string name(const Case& one) const;

 private:
  const Deviation& deviation(const Case& one) const;

  Body body_;
  std::vector<Deviation> deviations_, deviations_in_hand_;
  std::vector<Grasp> grasps_;
  std::vector<Eigen::VectorXd> postures_;
};

/// Cases in which a loop comes nearest to its limits.
struct Proof {
  double arm = 0.0, hand = 0.0;  ///< largest radius without and with a hand
  double friction = 0.0;  ///< largest radius in a hand during presliding; 0 without presliding
  Case worst_arm, worst_hand, worst_friction;

  bool holds() const {
    return arm < kArmRadius && hand < kHandRadius && friction < kFrictionRadius;
  }
};

}  // namespace hg::tune
