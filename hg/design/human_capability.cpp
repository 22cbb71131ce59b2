#include "hg/design/human_capability.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/random.h"

namespace hg::design {
namespace {

using std::numbers::pi;

constexpr std::uint64_t kVoxelsPerAxis = 1 << 10;  // around the origin of F

void check(const CapabilityOptions& options) {
  const auto require = [](bool holds, const char* rule, double got) {
    if (!holds) throw SetupError(fmt::format("human capability: {}, got {}", rule, got));
  };
  require(options.samples >= 1, "samples: at least 1", options.samples);
  require(options.poses >= 0, "poses: at least 0", options.poses);
  require(options.voxel >= 0.01 && options.voxel <= 1.0, "voxel: 0.01 to 1 m", options.voxel);
  require(options.orientation_bands >= 1 && options.orientation_bands <= 50,
          "orientation_bands: 1 to 50", options.orientation_bands);
  require(options.effort > 0.0 && options.effort <= 1.0, "effort: above 0, at most 1",
          options.effort);
}

ArmVector draw(const HumanArm& arm, Random& random) {
  ArmVector q;
  for (int i = 0; i < kArmJoints; ++i) {
    q[i] = random.between(arm.joints[i].range.lb, arm.joints[i].range.ub);
  }
  return q;
}

std::uint64_t voxel_of(const Eigen::Vector3d& p, double edge) {
  std::uint64_t key = 0;
  for (const double x : p) {
    const auto index = static_cast<std::int64_t>(std::floor(x / edge));
    key = key * kVoxelsPerAxis + static_cast<std::uint64_t>(index + kVoxelsPerAxis / 2);
  }
  return key;
}

// Index of `share` in [0, 1] among n equal parts.
std::uint64_t part_of(double share, int n) {
  return static_cast<std::uint64_t>(std::clamp(static_cast<int>(share * n), 0, n - 1));
}

// Cell of an orientation by its zyz Euler angles: equal parts of the azimuth, of the cosine of the
// tilt and of the roll have the same volume of rotations.
std::uint64_t orientation_of(const Eigen::Matrix3d& R, int bands) {
  const double azimuth = std::atan2(R(1, 2), R(0, 2));
  const double roll = std::atan2(R(2, 1), -R(2, 0));
  std::uint64_t key = part_of(0.5 * (R(2, 2) + 1.0), bands);
  key = key * 2 * bands + part_of((azimuth + pi) / (2 * pi), 2 * bands);
  return key * 2 * bands + part_of((roll + pi) / (2 * pi), 2 * bands);
}

// Shape matrix of the motion that joints within `most` give, by rows of the Jacobian.
Eigen::Matrix3d motion_ellipsoid(const Eigen::Matrix<double, 3, kArmJoints>& rows,
                                 const ArmVector& most) {
  const Eigen::Matrix<double, 3, kArmJoints> scaled = rows * most.asDiagonal();
  return scaled * scaled.transpose();
}

// Shape matrix of the forces that torques within `most` hold.
Eigen::Matrix3d force_ellipsoid(const Eigen::Matrix<double, 3, kArmJoints>& rows,
                                const ArmVector& most) {
  return motion_ellipsoid(rows, most.cwiseInverse()).inverse();
}

ArmVector of_joints(const HumanArm& arm, double ArmJoint::*member) {
  ArmVector values;
  for (int i = 0; i < kArmJoints; ++i) values[i] = arm.joints[i].*member;
  return values;
}

struct Cell {
  ArmVector q;
  double manipulability = -1.0;
  int samples = 0;
};

}  // namespace

HandPose hand_pose(const HumanArm& arm, const ArmVector& q, double effort) {
  const ArmPosture posture = arm_posture(arm, q);
  const auto linear = posture.J.topRows<3>();
  const auto angular = posture.J.bottomRows<3>();
  const ArmVector speeds = effort * of_joints(arm, &ArmJoint::dq_max);
  const ArmVector accelerations = effort * of_joints(arm, &ArmJoint::ddq_max);
  const ArmVector torques = of_joints(arm, &ArmJoint::torque);
  return {.T_F_hand = posture.T_F_hand,
          .q = q,
          .velocity = motion_ellipsoid(linear, speeds),
          .turn_velocity = motion_ellipsoid(angular, speeds),
          .acceleration = motion_ellipsoid(linear, accelerations),
          .turn_acceleration = motion_ellipsoid(angular, accelerations),
          .force = force_ellipsoid(linear, torques),
          .torque = force_ellipsoid(angular, torques)};
}

HumanCapability human_capability(const HumanArm& arm, const CapabilityOptions& options) {
  check(options);
  HumanCapability result;
  result.arm = arm;
  result.options = options;

  Random random(options.seed);
  const auto orientations = static_cast<std::uint64_t>(
      4 * options.orientation_bands * options.orientation_bands * options.orientation_bands);
  std::unordered_map<std::uint64_t, Cell> cells;
  std::unordered_set<std::uint64_t> voxels;
  int clear = 0;
  for (int i = 0; i < options.samples; ++i) {
    const ArmVector q = draw(arm, random);
    const ArmPosture posture = arm_posture(arm, q);
    if (!is_clear_of_body(arm, posture)) continue;
    ++clear;
    const std::uint64_t voxel = voxel_of(posture.T_F_hand.p, options.voxel);
    voxels.insert(voxel);
    Cell& cell =
        cells[voxel * orientations + orientation_of(posture.T_F_hand.R, options.orientation_bands)];
    ++cell.samples;
    const Eigen::Matrix<double, 6, 6> J_J_T = posture.J * posture.J.transpose();
    const double manipulability = J_J_T.determinant();
    if (manipulability > cell.manipulability) {
      cell.manipulability = manipulability;
      cell.q = q;
    }
  }
  result.share_clear = static_cast<double>(clear) / options.samples;
  result.voxels = static_cast<int>(voxels.size());
  result.volume = result.voxels * std::pow(options.voxel, 3);
  result.cells = static_cast<int>(cells.size());

  // in the order of their keys, then shuffled: the same with every standard library
  std::vector<std::pair<std::uint64_t, Cell>> chosen(cells.begin(), cells.end());
  std::ranges::sort(chosen, {}, &std::pair<std::uint64_t, Cell>::first);
  const std::size_t count = options.poses == 0
                                ? chosen.size()
                                : std::min(chosen.size(), static_cast<std::size_t>(options.poses));
  for (std::size_t i = 0; i < count; ++i) {
    const auto rest = static_cast<double>(chosen.size() - i);
    std::swap(chosen[i], chosen[i + static_cast<std::size_t>(rest * random.next())]);
    const Cell& cell = chosen[i].second;
    result.poses.push_back(hand_pose(arm, cell.q, options.effort));
    if (options.weight == PoseWeight::kSamples) result.poses.back().weight = cell.samples;
  }
  return result;
}

}  // namespace hg::design
