/// Capsules for the self-collision of an arm, fitted to the meshes of its links.
///
/// Links that are fixed to each other are one body. A body begins with one capsule; those that
/// stand out farthest where bodies come near each other are parted, as long as the control loop can
/// watch all pairs. Primitives of the URDF count as meshes where it has any. Set-up only: allocates
/// and takes seconds; the same files give the same capsules.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/commissioning/generator/capsules.h"
#include "hg/commissioning/generator/chain_part.h"
#include "hg/controller/safety/collision/pairs.h"
#include "hg/controller/safety/collision/shapes.h"
#include "hg/model/chain_data.h"

namespace hg::generator {

/// Largest number of pairs that a drafted device watches.
inline constexpr int kDraftedPairs = 60;

/// The capsules of one body.
struct FittedBody {
  std::string link;                ///< Link in whose frame they stand, the first of the body
  std::vector<std::string> files;  ///< Names of the mesh files
  std::vector<Capsule> capsules;
  double stands_out = 0.0;  ///< Largest distance from a capsule's surface to the meshes, m
};

struct SelfCollision {
  std::vector<FittedBody> bodies;  ///< Empty: the URDF has no meshes that can be read
  /// Links of bodies, two joints apart, whose meshes never come near each other
  std::vector<std::pair<std::string, std::string>> never_touch;
  double safe_distance = 0.0;            ///< Distance that is kept, m
  std::vector<collision::Shape> shapes;  ///< All shapes of the device, and the floor
  collision::Pairs pairs;                ///< Pairs of them that are watched, and that are not
  std::vector<std::string> unread;       ///< Mesh files that are missing or cannot be read
};

/// `ranges`: of the joints; `floor`: height of the floor in B, m, if it is watched; `progress`, if
/// given, is called after each step with the number of steps and the most.
SelfCollision fit_self_collision(const ChainPart& part, const model::ChainModel& chain,
                                 const std::vector<Interval>& ranges, std::optional<double> floor,
                                 const std::function<void(std::size_t, std::size_t)>& progress);

/// Smallest distance of the watched pairs in the posture of `chain`, m; infinite without pairs.
double smallest_distance(const SelfCollision& shapes, const model::ChainData& chain);

/// The lines of a device.yaml; empty without capsules.
std::string collision_lines(const SelfCollision& shapes);

/// What a user should know, in one line each.
std::vector<std::string> news_of(const SelfCollision& shapes);

}  // namespace hg::generator
