#include "hg/controller/safety/collision/reach_bounds.h"

#include <algorithm>
#include <cmath>

#include "hg/model/chain_data.h"

namespace hg::collision {
namespace {

constexpr double kUnlimitedStroke = 10.0;  // m, of a slide without limits

// Points that a shape with this radius around them is the hull of, in B.
std::vector<Eigen::Vector3d> corners(const Shape& shape, const Pose& T_B_shape) {
  std::vector<Eigen::Vector3d> points;
  if (!shape.is_box) {
    const Eigen::Vector3d half = shape.half_length * T_B_shape.R.col(2);
    return {T_B_shape.p + half, T_B_shape.p - half};
  }
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d p = shape.half_edges;
    for (int i = 0; i < 3; ++i) {
      if ((corner >> i & 1) != 0) p[i] = -p[i];
    }
    points.push_back(T_B_shape.p + T_B_shape.R * p);
  }
  return points;
}

// A frame on each body: of all frames the first that just this many joints move. `chain`: after
// update_kinematics().
int frame_on(const model::ChainData& chain, int body) {
  for (int frame = 0; frame < static_cast<int>(chain.model().frame_names().size()); ++frame) {
    const model::Jacobian& J = chain.jacobian(frame);
    int moved_by = 0;
    for (int i = 0; i < chain.model().nv(); ++i) {
      if (!J.col(i).isZero(0.0)) moved_by = i + 1;
    }
    if (moved_by == body) return frame;
  }
  return 0;
}

}  // namespace

ReachBounds::ReachBounds(model::ChainModel chain, std::vector<Interval> range)
    : chain_(std::move(chain)) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(chain_.model().nv());
  chain_.update_kinematics(chain_.model().neutral(), zero);
  for (int i = 0; i < chain_.model().nv(); ++i) {
    const bool is_slide = chain_.model().joints()[i].is_slide();
    const int frame = frame_on(chain_, i + 1);
    const Vector6 column = chain_.jacobian(frame).col(i);
    origin_.push_back(chain_.pose(frame).p);
    axis_.push_back(is_slide ? column.head<3>() : column.tail<3>());
    const double farthest = std::max(std::abs(range[i].lb), std::abs(range[i].ub));
    stroke_.push_back(is_slide ? std::min(farthest, kUnlimitedStroke) : 0.0);
  }
}

VectorPM ReachBounds::of(const Shape& shape, int from) const {
  VectorPM lever = VectorPM::Zero(chain_.model().nv());
  for (int i = from; i < shape.body; ++i) {
    const bool is_slide = chain_.model().joints()[i].is_slide();
    lever[i] = is_slide ? 1.0 : this->lever(i, shape);
  }
  return lever;
}

// The largest distance from the axis of a joint that a point of the core can have: the offsets
// from joint to joint, added up. While all axes are parallel only what is across them counts.
double ReachBounds::lever(int joint, const Shape& shape) const {
  constexpr double kParallel = 1e-9;
  const Eigen::Vector3d& axis = axis_[joint];
  bool is_parallel = true;
  const auto part = [&](const Eigen::Vector3d& offset) {
    return is_parallel ? offset.cross(axis).norm() : offset.norm();
  };
  double sum = 0.0;
  for (int i = joint + 1; i < shape.body; ++i) {
    sum += part(origin_[i] - origin_[i - 1]) + part(stroke_[i] * axis_[i]);
    const bool turns = !chain_.model().joints()[i].is_slide();
    if (turns && axis_[i].cross(axis).norm() > kParallel) is_parallel = false;
  }
  const Pose T_B_shape = chain_.pose(shape.frame) * shape.T_frame_shape;
  double farthest = 0.0;
  for (const Eigen::Vector3d& corner : corners(shape, T_B_shape)) {
    farthest = std::max(farthest, part(corner - origin_[shape.body - 1]));
  }
  return sum + farthest;
}

}  // namespace hg::collision
