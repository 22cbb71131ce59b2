/// Descriptions shared by several files: limits, poses.
///
/// A description is a function template: V is Loader or DocWriter.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "hg/config/range.h"
#include "hg/core/types.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/chain.h"
#include "hg/model/urdf.h"

namespace hg::config {

inline JointUnit unit_of(model::JointType type) {
  return type == model::JointType::kPrismatic ? JointUnit::kLength : JointUnit::kAngle;
}

inline constexpr JointKey kLowest = {"q_min_rad", "q_min_m"};
inline constexpr JointKey kHighest = {"q_max_rad", "q_max_m"};
inline constexpr JointKey kSpeed = {"dq_max_rad_per_s", "dq_max_m_per_s"};
inline constexpr JointKey kAcceleration = {"ddq_max_rad_per_s2", "ddq_max_m_per_s2"};

template <class V>
void describe_positions(V& v, limits::JointLimits& limits, JointUnit unit) {
  v.joint_number(kLowest, unit, limits.q_min, kUnlimited, "lowest position");
  v.joint_number(kHighest, unit, limits.q_max, kUnlimited, "highest position");
  v.rule(limits.q_min <= limits.q_max, kHighest.of(unit), "q_max must not be below q_min",
         model::to_text(limits.q_max) + " with q_min " + model::to_text(limits.q_min));
}

template <class V>
void describe_ratings(V& v, limits::JointLimits& limits, JointUnit unit, Need need) {
  v.joint_number(kSpeed, unit, limits.dq_max, kPositiveOrNone, "largest speed", need);
  v.joint_number(kAcceleration, unit, limits.ddq_max, kPositiveOrNone, "largest acceleration",
                 need);
}

/// The part of a URDF with branches: indices of links, -1 = not given.
struct ChainPart {
  int root_link = -1, tip_link = -1;
  bool is_usable = false;  ///< the links that are given exist
};

template <class V>
void describe(V& v, ChainPart& part, const std::vector<std::string>& links) {
  const bool has_root = v.name("root_link", part.root_link, links, "a link of the URDF",
                               "first link of the chain, in a URDF with branches") ||
                        !v.is_given("root_link");
  const bool has_tip =
      v.name("tip_link", part.tip_link, links, "a link of the URDF",
             "last link of the chain; joints beyond or beside it stand still at 0") ||
      !v.is_given("tip_link");
  part.is_usable = has_root && has_tip;
}

/// Position and roll, pitch, yaw as in a URDF: R = Rz(yaw) Ry(pitch) Rx(roll).
struct Placement {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
};

inline Pose pose_of(const Placement& placement) {
  const auto rotation = Eigen::AngleAxisd(placement.yaw, Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(placement.pitch, Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(placement.roll, Eigen::Vector3d::UnitX());
  return {placement.p, rotation.toRotationMatrix()};
}

template <class V>
void describe(V& v, Placement& placement) {
  v.number("x_m", placement.p.x(), kAnyNumber, "position");
  v.number("y_m", placement.p.y(), kAnyNumber, "position");
  v.number("z_m", placement.p.z(), kAnyNumber, "position");
  v.number("roll_rad", placement.roll, kAnyNumber, "about x, first");
  v.number("pitch_rad", placement.pitch, kAnyNumber, "about y, second");
  v.number("yaw_rad", placement.yaw, kAnyNumber, "about z, last");
}

/// A value per manipulator joint. A faulty file may name more joints than a device can have: these
/// are reported elsewhere and left out here.
inline VectorM per_joint(std::size_t joints, double value) {
  return VectorM::Constant(std::min(static_cast<int>(joints), kMaxManipulator), value);
}
inline void set_joint(VectorM& values, int index, double value) {
  if (index < values.size()) values[index] = value;
}

}  // namespace hg::config
