/// The bodies of an arm: links that are fixed to each other, with the triangles of their meshes and
/// the capsules around these. Set-up only: allocates.
#pragma once

#include <coal/BVH/BVH_model.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "hg/controller/safety/collision/shapes.h"
#include "hg/model/chain_data.h"
#include "hg/model/urdf.h"
#include "hg/new/capsules.h"
#include "hg/new/chain_part.h"

namespace hg::new_files {

using MeshModel = coal::BVHModel<coal::OBBRSS>;

/// Some of the triangles of a body, and the capsule around them.
struct Part {
  int number = 0;  ///< Of all parts that the body ever had
  std::vector<Triangle> triangles;
  std::shared_ptr<const MeshModel> mesh;  ///< Of the triangles
  Capsule capsule;
  double stands_out = 0.0;  ///< Largest distance of its surface from the mesh of the body, m
};

struct Body {
  std::string link;                ///< The first of its links, in whose frame all stands
  int frame = -1;                  ///< Of that link in the chain; -1 = B
  int joints = 0;                  ///< Number of joints that move it
  std::vector<std::string> files;  ///< Names of the mesh files
  std::vector<Triangle> triangles;
  std::shared_ptr<const MeshModel> mesh;
  std::vector<Part> parts;
  int parts_made = 0;
  double size = 0.0;  ///< Diagonal of the box around its meshes, m
};

/// The bodies of the chain from the root on, each with one part; primitives of the URDF count as
/// meshes. None where the URDF has no mesh that can be read; `unread`: names of the files that
/// cannot be.
std::vector<Body> read_bodies(const ChainPart& part, const model::Urdf& urdf,
                              const model::ChainModel& chain, std::vector<std::string>& unread);

/// Fits one capsule to all of the body, as its only part.
void begin_with_one(Body& body);

/// Parts one part in two; false where it cannot be parted.
bool part_in_two(Body& body, std::size_t index);

/// The capsule of a part as the control loop sees it, with a name like "link_1".
collision::Shape shape_of(const Body& body, std::size_t index);

/// Pose of a frame of the chain, -1 = B.
Pose pose_of(const model::ChainData& chain, int frame);

}  // namespace hg::new_files
