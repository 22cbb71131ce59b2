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

#include "hg/controller/safety/collision/pairs.h"
#include "hg/controller/safety/collision/shapes.h"
#include "hg/core/interval.h"
#include "hg/model/chain_model.h"
#include "hg/new/capsules.h"
#include "hg/new/chain_part.h"

namespace hg::new_files {

/// Largest number of pairs that a drafted device watches.
inline constexpr int kDraftedPairs = 60;
/// Capsules that are nearer to each other than this leave little room to move, m.
inline constexpr double kCrowded = 0.02;

/// The capsules of one body.
struct FittedBody {
  std::string link;                ///< Link in whose frame they stand, the first of the body
  std::vector<std::string> files;  ///< Names of the mesh files
  std::vector<Capsule> capsules;
  double stands_out = 0.0;  ///< Largest distance from a capsule's surface to the meshes, m
  double size = 0.0;        ///< Diagonal of the box around its meshes, m
};

/// Names of two bodies, or of two capsules, whose meshes never touch.
struct ApartPair {
  std::string a, b;
};

/// Two capsules that leave no room to move: watched, they would stop the arm in most postures.
struct CrowdedPair {
  std::string a, b;    ///< Their names
  double near = 0.0;   ///< Share of the postures in which they are near each other
  double touch = 0.0;  ///< Share of the postures in which the meshes in them touch, or nearly
};

struct SelfCollision {
  std::vector<FittedBody> bodies;        ///< Empty: the URDF has no meshes that can be read
  std::vector<ApartPair> apart;          ///< Bodies that are not watched
  std::vector<ApartPair> parts_apart;    ///< Capsules of other bodies that are not watched
  std::vector<CrowdedPair> crowded;      ///< The same
  double safe_distance = 0.0;            ///< Distance that is kept, m
  std::vector<collision::Shape> shapes;  ///< All shapes of the device, and the floor; without
                                         ///< bodies those of the URDF
  collision::Pairs pairs;                ///< Pairs of them that are watched, and that are not
  std::vector<std::string> unread;       ///< Mesh files that are missing or cannot be read
};

/// `ranges`: of the joints; `floor`: height of the floor in B, m, if it is watched; `progress`, if
/// given, is called after each step with the number of steps and the most.
SelfCollision fit_self_collision(const ChainPart& part, const model::ChainModel& chain,
                                 const std::vector<Interval>& ranges, std::optional<double> floor,
                                 const std::function<void(std::size_t, std::size_t)>& progress);

/// The lines of a device.yaml; empty without capsules.
std::string collision_lines(const SelfCollision& shapes);

/// What a user should know, in one line each.
std::vector<std::string> news_of(const SelfCollision& shapes);
/// Bodies whose size is that of no arm, in one line each.
std::vector<std::string> doubts_of(const SelfCollision& shapes);

}  // namespace hg::new_files
