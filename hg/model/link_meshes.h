/// The meshes that a URDF names as the shapes of its links.
#pragma once

#include <string>
#include <vector>

#include "hg/core/types.h"

namespace hg::model {

struct LinkMesh {
  std::string link;  ///< Name of the link
  std::string name;  ///< File name as it stands in the URDF
  Pose T_link_mesh;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  std::string fault;  ///< What is wrong with its scale, with the line before it; empty: nothing
};

/// The meshes of the <collision> elements, and those of the <visual> elements of links that have no
/// <collision>. `urdf` is the text of a URDF that can be read; what is not understood is left out.
std::vector<LinkMesh> link_meshes(const std::string& urdf);

}  // namespace hg::model
