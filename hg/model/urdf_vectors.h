/// The rpy and the mesh scales of a URDF as they are written, also where nothing else reads them.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace hg::model {

struct UrdfVector {
  std::string kind;  ///< "link" or "joint"
  std::string name;  ///< of that link or joint
  int line = 0;
  std::string text;                       ///< as it is written
  std::optional<Eigen::Vector3d> values;  ///< empty unless it is three finite numbers
};

struct UrdfVectors {
  std::vector<UrdfVector> turns;   ///< of <origin rpy>, rad
  std::vector<UrdfVector> scales;  ///< of <mesh scale>
};

/// Of all links and joints of the text of a URDF; empty if it cannot be read.
UrdfVectors urdf_vectors(const std::string& urdf);

/// Three finite numbers separated by blanks; empty if the text is anything else.
std::optional<Eigen::Vector3d> vector3_of(const std::string& text);

}  // namespace hg::model
