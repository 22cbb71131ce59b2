/// A twin from its YAML file: twin.yaml, described in docs/reference/configuration.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/sources.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/core/types.h"

namespace hg::config {

/// Scenery that a page draws around a twin; it cannot be felt.
enum class Surroundings { kRoom, kDoor, kExcavator };

struct Twin {
  std::string name;
  std::filesystem::path urdf;  ///< URDF that a page draws; empty for a free body without one
  Surroundings surroundings = Surroundings::kRoom;
  Pose T_B_root;  ///< placement of the root link
  rendering::TwinModel model;
  std::vector<SourceText> sources;  ///< source texts, the YAML file first
  Places places;                    ///< places of the keys of the YAML file
};

/// Loads a twin. Throws SetupError with all faults of the file, one per line.
Twin load_twin(const std::filesystem::path& file);
/// `has_moving_base`: the placement of the root link is where it rests at first.
Twin load_twin(const std::filesystem::path& file, SourceReader& reader,
               bool has_moving_base = false);

/// Pose of a hand in intuitive parameters: position in B, heading of the forearm, tilt s = q4 + q5
/// and roll q6 of the HapticGiant: R = Rz(azimuth) Ry(pi - pitch) Rz(pi + roll).
struct HandPose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double azimuth = 0.0;
  double pitch = 1.5707963267948966;  ///< hand axis horizontal
  double roll = 0.0;
};
Pose pose_of(const HandPose& hand);
/// Hand pose of a pose, pitch in [0, pi]; at 0 and pi, where only a sum is determined, roll is 0.
HandPose hand_of(const Pose& pose);

}  // namespace hg::config
