/// The collision geometry of a device as capsules and boxes.
///
/// A sphere is a capsule of length 0; a cylinder becomes the capsule around it: too large by at
/// most its radius at either end. What lies inside another shape of the same link is left out, so
/// that a cylinder with a sphere at each end is one capsule. Set-up only; throws SetupError.
#pragma once

#include <string>
#include <vector>

#include "hg/core/types.h"
#include "hg/model/chain_model.h"

namespace hg::model {
struct Urdf;
}

namespace hg::collision {

/// All points within `radius` of a segment (capsule) or all points of a box.
struct Shape {
  std::string name;  ///< Name of the collision element, else of its link
  int body = 0;      ///< Number of chain joints that move it: 0 = fixed to B
  int frame = -1;    ///< Frame of the chain that it is fixed to; -1 = B
  Pose T_frame_shape;
  double radius = 0.0;                                   ///< Radius of a capsule, m
  double half_length = 0.0;                              ///< Half length of its segment, along z, m
  Eigen::Vector3d half_edges = Eigen::Vector3d::Zero();  ///< Half edges of a box, m
  bool is_box = false;
  bool is_surrounding = false;  ///< Not part of the device: nothing touches it by design
};

struct Geometry {
  std::vector<Shape> shapes;
  std::vector<std::string> links_without;  ///< Moving links with mass but without known geometry
};

/// The shapes of `urdf`, the URDF or the part of it that `chain` was made of.
Geometry read_geometry(const model::Urdf& urdf, const model::ChainModel& chain);

/// The half space below `z` (m, in B), as a box that is large enough for every device.
Shape floor_at(double z);

/// The smallest capsule around a box that has its segment along the longest edge.
Shape capsule_around(const Shape& box);

/// Radius of the ball around the origin of the shape that holds all of it, m.
double reach(const Shape& shape) noexcept;

}  // namespace hg::collision
