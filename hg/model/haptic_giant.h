/// Kinematics of the HapticGiant in closed form: pose, inverse, Jacobian determinant, gantry
/// target.
///
/// Sources: [HG] Table I (lengths), sec. IV-A (zyz Euler angles), eq. (30) (gantry target).
/// With psi = q1+q2+q3 + pi, s = q4+q5, u = (cos psi, sin psi), r = L4 sin q4 + D6 sin s:
///   elbow = q_p + L1 e(q1) + L2 e(q1+q2) at height -D3,  hand = elbow + r u at -D3 - L4 cos q4 -
///   D6 cos s, R_B_H = Rz(psi) Ry(pi - s) Rz(q6 + pi),  hand axis z_H = sin s u - cos s z_B.
/// Differs from [HG]: frame B has z up, see models/README.md.
///
/// q_p: gantry (m), q_m: joints m1..m6 (rad). Pure functions: no state, no allocation, noexcept.
#pragma once

#include <string_view>

#include "hg/core/types.h"
#include "hg/model/chain_model.h"

namespace hg::model::haptic_giant {

/// Lengths of the five links, m; the defaults are those of [HG] Table I.
struct Lengths {
  double L1 = 0.53;  ///< Joint 1 to joint 2, m
  double L2 = 0.67;  ///< Joint 2 to joint 3, m
  double D3 = 0.75;  ///< Joint 3 down to joint 4 (elbow), m
  double L4 = 0.42;  ///< Joint 4 to joint 5, m
  double D6 = 0.12;  ///< Joint 5 to the handle, m
};

/// Lengths of a chain with two gantry joints and six manipulator joints, from poses of its frame
/// `handle`, rounded to 1 nm; throws SetupError where the chain is not built as a HapticGiant.
Lengths lengths_of(const ChainModel& chain, int handle);

/// Signs that select one of the eight solutions; the device works in (+, +, +).
struct Branch {
  int f = 1;  ///< Sign of sin(q4+q5), flip of the wrist
  int w = 1;  ///< Sign of sin q4, forearm towards u or away from it
  int k = 1;  ///< Sign of sin q2, side of the upper elbow
};

/// Outcome of the inverse kinematics.
enum class InverseStatus {
  kSolved,
  kSingular,           ///< hand axis vertical: exact, but only q1+q2+q3 -+ q6 is determined; q6 = 0
  kHeightOutOfReach,   ///< no q4 reaches this height; returns the nearest solution
  kDistanceOutOfReach  ///< no q2 reaches this distance from q_p; returns the nearest
};

std::string_view to_string(InverseStatus status) noexcept;

/// R_B_H for heading psi, tilt s = q4+q5 and roll q6: Rz(psi) Ry(pi - s) Rz(q6 + pi).
Eigen::Matrix3d hand_orientation(double psi, double s, double q6) noexcept;

/// Pose T_B_H of the handle.
Pose hand_pose(const Eigen::Vector2d& q_p, const Vector6& q_m,
               const Lengths& lengths = {}) noexcept;

/// Origin of joint 4 in B.
Eigen::Vector3d elbow(const Eigen::Vector2d& q_p, const Vector6& q_m,
                      const Lengths& lengths = {}) noexcept;

/// Joint angles in [-pi, pi) that bring the handle to T_B_H with the gantry at q_p.
[[nodiscard]] InverseStatus inverse(const Pose& T_B_H, const Eigen::Vector2d& q_p, Branch branch,
                                    Vector6& q_m, const Lengths& lengths = {}) noexcept;

/// Determinant of the Jacobian (6 x 6) of m1..m6 at the handle; zero if sin q2, sin q4 or
/// sin(q4+q5) is zero.
double jacobian_determinant(const Vector6& q_m, const Lengths& lengths = {}) noexcept;

/// Gantry position that brings q2 to pi/2 and q3 to -atan(L1/L2) at the same handle pose, (30).
Eigen::Vector2d gantry_target(const Eigen::Vector2d& q_p, const Vector6& q_m,
                              const Lengths& lengths = {}) noexcept;

/// Gantry and joint positions that reach T_B_H in the posture of (30); `branch.k` is +.
[[nodiscard]] InverseStatus inverse_at_target(const Pose& T_B_H, Eigen::Vector2d& q_p, Vector6& q_m,
                                              Branch branch = {},
                                              const Lengths& lengths = {}) noexcept;

/// angle + n * 2 pi nearest to `previous`; keeps the unlimited joint m1 unwrapped.
double nearest_turn(double angle, double previous) noexcept;

}  // namespace hg::model::haptic_giant
