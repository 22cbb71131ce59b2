#include "hg/simulator/person/doorway.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"

namespace hg::person {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUpright = 0.999;  // cosine, of a hinge axis with the vertical

}  // namespace

void place(Doorway& doorway, const model::ChainModel& twin, int end_effector) {
  const model::Joint& joint = twin.joints()[doorway.joint];
  model::ChainData shut(twin);
  shut.update_kinematics(twin.neutral(), VectorA::Zero(twin.nv()));
  const Vector6 column = shut.jacobian(end_effector).col(joint.v_index);
  const Vector3d axis = column.tail<3>();
  const Pose& handle = shut.pose(end_effector);
  const Vector3d from_axis = column.head<3>().cross(axis);
  const Vector3d to_person = handle.R.col(2);
  const Vector3d along = from_axis - to_person * to_person.dot(from_axis);
  if (std::abs(axis.z()) < kUpright || !(along.head<2>().norm() > 0.0)) {
    throw SetupError("needs a vertical hinge beside the handle");
  }
  doorway.hinge = (handle.p - from_axis).head<2>();
  doorway.handle_radius = along.head<2>().norm();
  doorway.handle_offset = to_person.dot(from_axis);
  doorway.along = along.head<2>() / doorway.handle_radius;
  doorway.away = axis.cross(along).head<2>() / doorway.handle_radius;
  if (to_person.head<2>().dot(doorway.away) >= 0.0) {
    throw SetupError("needs a leaf that opens away from the person");
  }
}

double leaf_angle(const Doorway& doorway, const Vector3d& p_H) noexcept {
  const Vector2d p = doorway.local(p_H.head<2>());
  return std::atan2(p.y(), p.x()) + std::atan2(doorway.handle_offset, doorway.handle_radius);
}

double leaf_distance(const Doorway& doorway, double angle, const Vector2d& p) noexcept {
  const Vector2d leaf(std::cos(angle), std::sin(angle));
  return (p - leaf * std::clamp(leaf.dot(p), 0.0, doorway.leaf_width)).norm();
}

double frame_distance(const Doorway& doorway, const Vector2d& p) noexcept {
  // the frame continues to either side of the opening
  const double inside = std::min(p.x(), doorway.clear_width - p.x());
  return std::hypot(std::max(inside, 0.0), p.y());
}

double angle_needed(const Doorway& doorway, const Vector2d& p, double room) noexcept {
  const double away = p.norm(), width = doorway.leaf_width;
  if (away >= width + room) return 0.0;
  if (away <= room) return std::numbers::pi;  // at the hinge itself
  // the leaf is met at its face, or at its edge
  const double face = std::sqrt(away * away - room * room);
  const double aside = face <= width
                           ? std::asin(room / away)
                           : std::acos(std::min(1.0, (away * away + width * width - room * room) /
                                                         (2.0 * away * width)));
  return std::max(0.0, std::atan2(p.y(), p.x()) + aside);
}

bool is_clear_of_leaf(const Doorway& doorway, const Vector2d& p, double room) noexcept {
  return p.y() > 0.0 && p.norm() >= doorway.leaf_width + room;
}

}  // namespace hg::person
