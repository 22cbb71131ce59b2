#include "hg/model/haptic_giant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

Wrist solve_wrist(const Pose& T_B_H, int f, int w) noexcept {
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

  const double cos_q4 = (-kD3 - kD6 * std::cos(wrist.s) - T_B_H.p.z()) / kL4;
  if (std::abs(cos_q4) > kLargestCosine) wrist.status = InverseStatus::kHeightOutOfReach;
  wrist.q4 = w * std::acos(std::clamp(cos_q4, -1.0, 1.0));

  const double r = kL4 * std::sin(wrist.q4) + kD6 * std::sin(wrist.s);
  wrist.elbow = T_B_H.p.head<2>() - r * e(wrist.psi);
  return wrist;
}

Vector6 assemble(const Wrist& wrist, double q1, double q2) noexcept {
  Vector6 q_m;
  q_m << q1, q2, wrist.psi - pi - q1 - q2, wrist.q4, wrist.s - wrist.q4, wrist.q6;
  return q_m.unaryExpr([](double angle) { return wrap(angle); });
}

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

Eigen::Vector3d elbow(const Eigen::Vector2d& q_p, const Vector6& q_m) noexcept {
  const Eigen::Vector2d xy = q_p + kL1 * e(q_m[0]) + kL2 * e(q_m[0] + q_m[1]);
  return {xy.x(), xy.y(), -kD3};
}

Eigen::Matrix3d hand_orientation(double psi, double s, double q6) noexcept {
  return R_z(psi) * R_y(pi - s) * R_z(q6 + pi);
}

Pose hand_pose(const Eigen::Vector2d& q_p, const Vector6& q_m) noexcept {
  const double psi = q_m[0] + q_m[1] + q_m[2] + pi;
  const double s = q_m[3] + q_m[4];
  const Eigen::Vector2d reach = (kL4 * std::sin(q_m[3]) + kD6 * std::sin(s)) * e(psi);
  const double height = -kL4 * std::cos(q_m[3]) - kD6 * std::cos(s);
  return {elbow(q_p, q_m) + Eigen::Vector3d(reach.x(), reach.y(), height),
          hand_orientation(psi, s, q_m[5])};
}

InverseStatus inverse(const Pose& T_B_H, const Eigen::Vector2d& q_p, Branch branch,
                      Vector6& q_m) noexcept {
  const Wrist wrist = solve_wrist(T_B_H, branch.f, branch.w);
  const Eigen::Vector2d d = wrist.elbow - q_p;
  const double cos_q2 = (d.squaredNorm() - kL1 * kL1 - kL2 * kL2) / (2.0 * kL1 * kL2);
  const double q2 = branch.k * std::acos(std::clamp(cos_q2, -1.0, 1.0));
  const double q1 =
      std::atan2(d.y(), d.x()) - std::atan2(kL2 * std::sin(q2), kL1 + kL2 * std::cos(q2));
  q_m = assemble(wrist, q1, q2);
  if (wrist.status == InverseStatus::kHeightOutOfReach) return wrist.status;
  return std::abs(cos_q2) > kLargestCosine ? InverseStatus::kDistanceOutOfReach : wrist.status;
}

double jacobian_determinant(const Vector6& q_m) noexcept {
  return -kL1 * kL2 * kL4 * std::sin(q_m[1]) * std::sin(q_m[3]) * std::sin(q_m[3] + q_m[4]);
}

Eigen::Vector2d gantry_target(const Eigen::Vector2d& q_p, const Vector6& q_m) noexcept {
  const double psi = q_m[0] + q_m[1] + q_m[2] + pi;
  return elbow(q_p, q_m).head<2>() + std::hypot(kL1, kL2) * e(psi);
}

InverseStatus inverse_at_target(const Pose& T_B_H, Eigen::Vector2d& q_p, Vector6& q_m) noexcept {
  const Wrist wrist = solve_wrist(T_B_H, 1, 1);
  const double q2 = 0.5 * pi;
  const double q3 = -std::atan2(kL1, kL2);
  q_p = wrist.elbow + std::hypot(kL1, kL2) * e(wrist.psi);
  q_m = assemble(wrist, wrist.psi - pi - q2 - q3, q2);
  return wrist.status;
}

double nearest_turn(double angle, double previous) noexcept {
  const double turns = std::floor((angle - previous + pi) / (2.0 * pi));
  return angle - turns * 2.0 * pi;
}

}  // namespace hg::model::haptic_giant
