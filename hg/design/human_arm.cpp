#include "hg/design/human_arm.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/core/error.h"

namespace hg::design {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
constexpr double kShortest = 1.2, kTallest = 2.3;  // m
constexpr double kArmRadius = 0.04;                // [A] of forearm and hand, m

// [GB14]: mean and standard deviation of the stature, m
struct Population {
  double mean, deviation;
};
constexpr Population kMen = {1.756, 0.0686}, kWomen = {1.628, 0.0642};

// shares of the stature: [DC66], the grip [HANDBOOK] 8.1
constexpr double kShoulderHeight = 0.818, kHalfBreadth = 0.129, kUpperArm = 0.186, kForearm = 0.146;
constexpr double kGrip = 0.08 / 1.75;

// [A] shares of the stature: a trunk of two capsules side by side, 0.30 m wide and 0.23 m deep in a
// man of 1.75 m, a head and two legs
struct Part {
  double y, bottom, top, radius;
};
constexpr std::array kBody = {Part{0.02, 0.56, 0.75, 0.065}, Part{-0.02, 0.56, 0.75, 0.065},
                              Part{0.0, 0.87, 0.94, 0.055}, Part{0.05, 0.05, 0.50, 0.045},
                              Part{-0.05, 0.05, 0.50, 0.045}};

// In degrees, rad/s, rad/s^2, Nm; of men. `share` is the strength of women.
struct JointRow {
  std::string_view name;
  double from, to, dq_max, ddq_max, torque, share;
};
// Ranges [BA79]; abduction beyond 90 degrees is flexion beyond 90 with the arm turned, so that it
// would count twice, or lie behind the back; adduction [K]. Speeds and accelerations [K]. Torques:
// shoulder flexion by a published mean, wrist [DG96], others [A]; shares of women: shoulder
// likewise, elbow [KB85], wrist [WI25], others by their neighbours.
constexpr std::array<JointRow, kArmJoints> kJoints = {{
    {"shoulder flexion", -62, 167, 5, 40, 69, 0.50},
    {"shoulder abduction", -30, 90, 5, 40, 60, 0.50},
    {"upper arm rotation", -104, 69, 7, 60, 35, 0.50},
    {"elbow flexion", 0, 143, 7, 60, 45, 0.62},
    {"pronation", -82, 76, 10, 120, 8, 0.64},
    {"wrist flexion", -75, 76, 8, 120, 7.1, 0.64},
    {"radial deviation", -36, 22, 6, 100, 9.5, 0.64},
}};
constexpr double kSpeedOfWomen = 0.9;  // [KB85]: arm flexion

// z with the share `p` of a standard normal distribution below it
double normal_quantile(double p) {
  double low = -10.0, high = 10.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Squared distance of two segments: closest points by clamping, Ericson, Real-Time Collision
// Detection, 5.1.9.
double squared_distance(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1,
                        const Eigen::Vector3d& b0, const Eigen::Vector3d& b1) {
  const Eigen::Vector3d u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double a = u.dot(u), e = v.dot(v), f = v.dot(w), c = u.dot(w), b = u.dot(v);
  const double denominator = a * e - b * b;
  double s = denominator > 1e-12 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / a, 0.0, 1.0);
  }
  return (w + s * u - t * v).squaredNorm();
}

}  // namespace

std::string_view to_string(Sex sex) noexcept { return sex == Sex::kFemale ? "female" : "male"; }

double stature_of(Sex sex, double percentile) {
  if (!(percentile > 0.0 && percentile < 100.0)) {
    throw SetupError(
        fmt::format("stature percentile: between 0 and 100, both excluded, got {}", percentile));
  }
  const Population& population = sex == Sex::kFemale ? kWomen : kMen;
  return population.mean + population.deviation * normal_quantile(percentile / 100.0);
}

HumanArm human_arm(Sex sex, double stature_percentile) {
  return human_arm_of_stature(sex, stature_of(sex, stature_percentile));
}

HumanArm human_arm_of_stature(Sex sex, double stature) {
  if (!(stature >= kShortest && stature <= kTallest)) {
    throw SetupError(fmt::format("stature: {} to {} m, got {:.4g}", kShortest, kTallest, stature));
  }
  HumanArm arm;
  arm.sex = sex;
  arm.stature = stature;
  arm.p_shoulder = {0.0, -kHalfBreadth * stature, kShoulderHeight * stature};
  arm.upper_arm = kUpperArm * stature;
  arm.forearm = kForearm * stature;
  arm.hand = kGrip * stature;
  const bool is_woman = sex == Sex::kFemale;
  std::ranges::transform(kJoints, arm.joints.begin(), [&](const JointRow& row) {
    const double speed = is_woman ? kSpeedOfWomen : 1.0;
    return ArmJoint{row.name,
                    {row.from * kDegree, row.to * kDegree},
                    speed * row.dq_max,
                    speed * row.ddq_max,
                    (is_woman ? row.share : 1.0) * row.torque};
  });
  for (const Part& part : kBody) {
    arm.body.push_back({stature * Eigen::Vector3d(0.0, part.y, part.bottom),
                        stature * Eigen::Vector3d(0.0, part.y, part.top), stature * part.radius});
  }
  return arm;
}

ArmPosture arm_posture(const HumanArm& arm, const ArmVector& q) noexcept {
  // axes in the link before each joint, and the way to the next joint; the arm hangs along -z
  static const std::array<Eigen::Vector3d, kArmJoints> kAxes = {
      -Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(),
      -Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),  Eigen::Vector3d::UnitX(),
      -Eigen::Vector3d::UnitY()};
  ArmPosture posture;
  std::array<Eigen::Vector3d, kArmJoints> axes, origins;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = arm.p_shoulder;
  for (int i = 0; i < kArmJoints; ++i) {
    if (i == 3) posture.p_elbow = p = p - arm.upper_arm * R.col(2);
    if (i == 5) posture.p_wrist = p = p - arm.forearm * R.col(2);
    origins[i] = p;
    axes[i] = R * kAxes[i];
    R = R * Eigen::AngleAxisd(q[i], kAxes[i]).toRotationMatrix();
  }
  p -= arm.hand * R.col(2);
  posture.T_F_hand.p = p;
  posture.T_F_hand.R << -R.col(2), R.col(1), R.col(0);
  for (int i = 0; i < kArmJoints; ++i) {
    posture.J.col(i) << axes[i].cross(p - origins[i]), axes[i];
  }
  return posture;
}

bool is_clear_of_body(const HumanArm& arm, const ArmPosture& posture) noexcept {
  const Eigen::Vector3d middle = 0.5 * (arm.p_shoulder + posture.p_elbow);
  const std::array segments = {std::pair{middle, posture.p_elbow},
                               std::pair{posture.p_elbow, posture.p_wrist},
                               std::pair{posture.p_wrist, posture.T_F_hand.p}};
  for (const Capsule& part : arm.body) {
    const double clearance = part.radius + kArmRadius;
    for (const auto& [from, to] : segments) {
      if (squared_distance(from, to, part.from, part.to) < clearance * clearance) return false;
    }
  }
  return true;
}

}  // namespace hg::design
