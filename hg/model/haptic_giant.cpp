#include "hg/model/haptic_giant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"

namespace hg::model::haptic_giant {
namespace {

using std::numbers::pi;

// sine of the hand axis' angle to the vertical below which its heading is rounding noise
constexpr double kVertical = 1e-12;
// tolerance for rounding of a cosine at the stretched arm
constexpr double kLargestCosine = 1.0 + 1e-12;

Eigen::Vector2d e(double angle) noexcept { return {std::cos(angle), std::sin(angle)}; }

double wrap(double angle) noexcept { return nearest_turn(angle, 0.0); }

Eigen::Matrix3d R_z(double angle) noexcept {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

Eigen::Matrix3d R_y(double angle) noexcept {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
}

// Joints beyond the drop tube: depend on the pose of the handle alone.
struct Wrist {
  double psi, s, q4, q6;
  Eigen::Vector2d elbow;
  InverseStatus status;
};

Wrist solve_wrist(const Pose& T_B_H, int f, int w, const Lengths& lengths) noexcept {
  const Eigen::Matrix3d& C = T_B_H.R;
  Wrist wrist = {};
  const double sin_beta = std::hypot(C(0, 2), C(1, 2));
  wrist.s = pi - std::atan2(f * sin_beta, C(2, 2));
  if (sin_beta > kVertical) {
    wrist.psi = std::atan2(f * C(1, 2), f * C(0, 2));
    wrist.q6 = std::atan2(f * C(2, 1), -f * C(2, 0)) - pi;
  } else {
    // with q6 = 0: C = Rz(psi) diag(1, -1, -1) for s = 0, C = Rz(psi + pi) for s = pi
    const double side = C(2, 2) > 0.0 ? 1.0 : -1.0;
    wrist.psi = std::atan2(side * C(1, 0), side * C(0, 0)) + pi;
    wrist.status = InverseStatus::kSingular;
  }

  const double cos_q4 = (-lengths.D3 - lengths.D6 * std::cos(wrist.s) - T_B_H.p.z()) / lengths.L4;
  if (std::abs(cos_q4) > kLargestCosine) wrist.status = InverseStatus::kHeightOutOfReach;
  wrist.q4 = w * std::acos(std::clamp(cos_q4, -1.0, 1.0));

  const double r = lengths.L4 * std::sin(wrist.q4) + lengths.D6 * std::sin(wrist.s);
  wrist.elbow = T_B_H.p.head<2>() - r * e(wrist.psi);
  return wrist;
}

Vector6 assemble(const Wrist& wrist, double q1, double q2) noexcept {
  Vector6 q_m;
  q_m << q1, q2, wrist.psi - pi - q1 - q2, wrist.q4, wrist.s - wrist.q4, wrist.q6;
  return q_m.unaryExpr([](double angle) { return wrap(angle); });
}

// Without the rounding of poses: lengths as they stand in the URDF.
double to_nanometres(double length_m) { return std::round(1e9 * length_m) / 1e9; }

}  // namespace

std::string_view to_string(InverseStatus status) noexcept {
  switch (status) {
    case InverseStatus::kSolved:
      return "solved";
    case InverseStatus::kSingular:
      return "singular";
    case InverseStatus::kHeightOutOfReach:
      return "height out of reach";
    case InverseStatus::kDistanceOutOfReach:
      return "distance out of reach";
  }
  return "unknown";
}

Lengths lengths_of(const ChainModel& chain, int handle) {
  if (chain.nv() != 8 || chain.nq() != 8) {
    throw SetupError("the closed form needs two gantry joints and six manipulator joints");
  }
  ChainData data(chain);
  const auto pose = [&](const Eigen::Vector2d& q_p, const Vector6& q_m) -> Pose {
    Eigen::VectorXd q(8);
    q << q_p, q_m;
    data.update_poses(q);
    return data.pose(handle);
  };
  const auto at = [&](double q2, double q4, double q5) -> Eigen::Vector3d {
    return pose({0, 0}, (Vector6() << 0, q2, 0, q4, q5, 0).finished()).p;
  };
  const Eigen::Vector3d hanging = at(0, 0, 0);
  const double folded_x = at(pi, 0, 0).x();
  const double level_z = at(0, pi / 2, 0).z();
  const double D6 = at(0, pi / 2, pi / 2).z() - level_z;
  const Lengths lengths = {.L1 = to_nanometres((hanging.x() + folded_x) / 2),
                           .L2 = to_nanometres((hanging.x() - folded_x) / 2),
                           .D3 = to_nanometres(-level_z),
                           .L4 = to_nanometres(level_z - hanging.z() - D6),
                           .D6 = to_nanometres(D6)};

  // postures in which every joint and length counts
  constexpr double kSame = 1e-6;  // m and 1
  const Eigen::Vector2d q_p(0.3, -0.2);
  for (double angle : {0.4, 1.1}) {
    const Vector6 q_m =
        (Vector6() << angle, 1.2, -0.5 - angle, 0.9 * angle, 0.3, -0.7 * angle).finished();
    const Pose expected = hand_pose(q_p, q_m, lengths);
    const Pose is = pose(q_p, q_m);
    if ((is.p - expected.p).norm() < kSame && (is.R - expected.R).norm() < kSame) continue;
    throw SetupError(
        "the joints are not arranged as those of a HapticGiant; with "
        "'kinematics: general' and a posture the device works");
  }
  return lengths;
}

Eigen::Vector3d elbow(const Eigen::Vector2d& q_p, const Vector6& q_m,
                      const Lengths& lengths) noexcept {
  const Eigen::Vector2d xy = q_p + lengths.L1 * e(q_m[0]) + lengths.L2 * e(q_m[0] + q_m[1]);
  return {xy.x(), xy.y(), -lengths.D3};
}

Eigen::Matrix3d hand_orientation(double psi, double s, double q6) noexcept {
  return R_z(psi) * R_y(pi - s) * R_z(q6 + pi);
}

Pose hand_pose(const Eigen::Vector2d& q_p, const Vector6& q_m, const Lengths& lengths) noexcept {
  const double psi = q_m[0] + q_m[1] + q_m[2] + pi;
  const double s = q_m[3] + q_m[4];
  const Eigen::Vector2d reach = (lengths.L4 * std::sin(q_m[3]) + lengths.D6 * std::sin(s)) * e(psi);
  const double height = -lengths.L4 * std::cos(q_m[3]) - lengths.D6 * std::cos(s);
  return {elbow(q_p, q_m, lengths) + Eigen::Vector3d(reach.x(), reach.y(), height),
          hand_orientation(psi, s, q_m[5])};
}

InverseStatus inverse(const Pose& T_B_H, const Eigen::Vector2d& q_p, Branch branch, Vector6& q_m,
                      const Lengths& lengths) noexcept {
  const Wrist wrist = solve_wrist(T_B_H, branch.f, branch.w, lengths);
  const Eigen::Vector2d d = wrist.elbow - q_p;
  const double cos_q2 = (d.squaredNorm() - lengths.L1 * lengths.L1 - lengths.L2 * lengths.L2) /
                        (2.0 * lengths.L1 * lengths.L2);
  const double q2 = branch.k * std::acos(std::clamp(cos_q2, -1.0, 1.0));
  const double q1 = std::atan2(d.y(), d.x()) -
                    std::atan2(lengths.L2 * std::sin(q2), lengths.L1 + lengths.L2 * std::cos(q2));
  q_m = assemble(wrist, q1, q2);
  if (wrist.status == InverseStatus::kHeightOutOfReach) return wrist.status;
  return std::abs(cos_q2) > kLargestCosine ? InverseStatus::kDistanceOutOfReach : wrist.status;
}

double jacobian_determinant(const Vector6& q_m, const Lengths& lengths) noexcept {
  return -lengths.L1 * lengths.L2 * lengths.L4 * std::sin(q_m[1]) * std::sin(q_m[3]) *
         std::sin(q_m[3] + q_m[4]);
}

Eigen::Vector2d gantry_target(const Eigen::Vector2d& q_p, const Vector6& q_m,
                              const Lengths& lengths) noexcept {
  const double psi = q_m[0] + q_m[1] + q_m[2] + pi;
  return elbow(q_p, q_m, lengths).head<2>() + std::hypot(lengths.L1, lengths.L2) * e(psi);
}

InverseStatus inverse_at_target(const Pose& T_B_H, Eigen::Vector2d& q_p, Vector6& q_m,
                                Branch branch, const Lengths& lengths) noexcept {
  const Wrist wrist = solve_wrist(T_B_H, branch.f, branch.w, lengths);
  const double q2 = 0.5 * pi;
  const double q3 = -std::atan2(lengths.L1, lengths.L2);
  q_p = wrist.elbow + std::hypot(lengths.L1, lengths.L2) * e(wrist.psi);
  q_m = assemble(wrist, wrist.psi - pi - q2 - q3, q2);
  return wrist.status;
}

double nearest_turn(double angle, double previous) noexcept {
  const double turns = std::floor((angle - previous + pi) / (2.0 * pi));
  return angle - turns * 2.0 * pi;
}

}  // namespace hg::model::haptic_giant
