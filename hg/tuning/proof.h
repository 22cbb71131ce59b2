/// Whether a torque loop tolerates what nobody knows of an arm and of who holds it.
#pragma once

#include <string>
#include <vector>

#include "hg/tuning/handle_loop.h"

namespace hg::tuning {

/// Something that the controller does not know.
struct Doubt {
  std::string what;  ///< "springs x 0.75"
  control::Reality reality;
  double follower = 1.0;  ///< factor of flatness_Hz
  double mass = 1.0;      ///< factor of the lightest bodies
  double fed = -1.0;      ///< factor of friction that gives way and is fed forward; < 0: none does
};

/// As believed; rotors, springs and links of 0.75 and 1.25 times what is believed; each by itself,
/// like those that doubts_in_hand() adds.
std::vector<Doubt> doubts(const control::Config& believed);

/// What counts in a hand: as believed; 1.5 times the latency; torques that follow half as fast.
/// They do that where motors are at their peak (follow_torque() in control/joint_control.cpp), and
/// a hand that is stable without may swing for ever with it.
std::vector<Doubt> doubts_in_hand(const control::Config& believed);

/// Where joints have presliding: their friction has not slipped, and is as stiff as half of what is
/// believed, as that, and as 1.25 times that; what is fed forward is 0.5 to 1.25 times as stiff as
/// it is. In hands, with the body itself. Empty for a device without presliding.
std::vector<Doubt> doubts_in_friction(const control::Config& believed);

/// A hand that holds the handle of a body.
struct Grasp {
  std::string what;  ///< "stiff hand"
  user::HandImpedance hand;
  Body body;
};

/// The hands of [HANDBOOK] 5.1 and arms on lightly damped springs of 300 to 2000 N/m, with bodies
/// so light (no heavier than `body`) that little is left where nothing is known for sure.
std::vector<Grasp> grasps(const Body& body);

/// What a loop must tolerate in one posture: one of doubts() without a hand, with one of
/// doubts_in_hand() and, behind them, of doubts_in_friction().
struct Case {
  std::size_t posture = 0, doubt = 0;
  int grasp = -1;  ///< -1 = without a hand

  bool operator==(const Case&) const = default;
};

inline constexpr double kArmRadius = 0.995;    ///< per millisecond: errors fall to 37 % in 0.2 s
inline constexpr double kHandRadius = 0.9996;  ///< in 2.5 s: a hand's own slow motions count
/// Friction that holds lets go of nothing fast: small motions must die out at all.
inline constexpr double kFrictionRadius = 1.0;

/// Everything that a torque loop must tolerate.
class Demands {
 public:
  Demands(const control::Config& believed, const Body& body, std::vector<Eigen::VectorXd> postures);

  const std::vector<Eigen::VectorXd>& postures() const { return postures_; }
  /// Whether it is one of doubts_in_friction().
  bool is_friction(const Case& one) const { return doubt(one).fed >= 0.0; }
  /// All cases of a posture.
  std::vector<Case> cases(std::size_t posture) const;
  /// Largest modulus of the eigenvalues of `device`, per millisecond.
  double radius(const Device& device, const Case& one) const;
  /// > 0 where that does not die out in time: by how much.
  double excess(const Device& device, const Case& one) const;
  /// "stiff hand, 0.4 kg, latency x 1.5".
  std::string name(const Case& one) const;

 private:
  const Doubt& doubt(const Case& one) const;

  Body body_;
  std::vector<Doubt> doubts_, doubts_in_hand_;
  std::vector<Grasp> grasps_;
  std::vector<Eigen::VectorXd> postures_;
};

/// Where a loop comes nearest to its limits.
struct Proof {
  double arm = 0.0, hand = 0.0;  ///< largest radius without and with a hand
  double friction = 0.0;         ///< in a hand while friction gives way; 0 without presliding
  Case worst_arm, worst_hand, worst_friction;

  bool holds() const {
    return arm < kArmRadius && hand < kHandRadius && friction < kFrictionRadius;
  }
};

}  // namespace hg::tuning
