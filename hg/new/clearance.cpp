#include "hg/new/clearance.h"

#include <coal/collision.h>
#include <coal/distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <utility>

#include "hg/controller/safety/collision/distance.h"

namespace hg::new_files {
namespace {

coal::Transform3s transform_of(const Pose& pose) { return {pose.R, pose.p}; }

// Postures of two joints around a middle, and what is known of the distance in all of them.
struct Cell {
  std::array<double, 2> middle = {}, half = {};
  double bound = 0.0;  // m, the distance is at least this
};

struct IsFarther {
  bool operator()(const Cell& a, const Cell& b) const { return a.bound > b.bound; }
};

// Ranges of a joint in which a search begins; a joint without stops turns once.
Interval searched(const Interval& range) {
  return {std::isfinite(range.lb) ? range.lb : -M_PI, std::isfinite(range.ub) ? range.ub : M_PI};
}

}  // namespace

PartPair pair_of(const Body& a, std::size_t i, const Body& b, std::size_t k) {
  return {a.joints, a.parts[i].number, b.joints, b.parts[k].number};
}

Clearance::Clearance(const model::ChainModel& chain, const std::vector<Interval>& ranges)
    : chain_(chain), ranges_(ranges), levers_(chain, ranges) {
  for (Interval& range : ranges_) range = searched(range);
}

bool Clearance::is_proven(const Body& a, std::size_t i, const Body& b, std::size_t k) {
  if (b.joints - a.joints != 2) return false;
  const auto [known, is_new] = known_.try_emplace(pair_of(a, i, b, k), false);
  if (is_new) known->second = prove(a, i, b, k);
  return known->second;
}

// The cell with the smallest bound is halved until all bounds are large enough, or a posture is
// found in which they are not.
bool Clearance::prove(const Body& a, std::size_t i, const Body& b, std::size_t k) {
  constexpr int kMost = 2000;  // distances between meshes; beyond these nothing is proven
  const collision::Shape shape = shape_of(b, k);
  const collision::Distance capsules(shape_of(a, i), shape);
  const auto levers = levers_.of(shape, a.joints);
  const int first = a.joints;
  Eigen::VectorXd q(static_cast<Eigen::Index>(ranges_.size()));
  for (int n = 0; n < q.size(); ++n) q[n] = 0.5 * (ranges_[n].lb + ranges_[n].ub);

  int left = kMost;
  const coal::DistanceRequest request;
  // all of the mesh is within the radius
  const auto travel = [&](const Cell& cell, int n) {
    return (levers[first + n] + shape.radius) * cell.half[n];
  };
  // sets the bound; false when the meshes are too near in the middle
  const auto measure = [&](Cell& cell) {
    for (int n = 0; n < 2; ++n) q[first + n] = cell.middle[n];
    chain_.update_poses(q);
    const Pose T_B_a = pose_of(chain_, a.frame), T_B_b = pose_of(chain_, b.frame);
    const double most = travel(cell, 0) + travel(cell, 1);
    cell.bound = capsules(T_B_a, T_B_b) - most;
    if (cell.bound > kMeshMargin) return true;
    --left;
    coal::DistanceResult result;
    const double distance =
        coal::distance(a.parts[i].mesh.get(), transform_of(T_B_a), b.parts[k].mesh.get(),
                       transform_of(T_B_b), request, result);
    cell.bound = distance - most;
    return distance > kMeshMargin;
  };

  std::priority_queue<Cell, std::vector<Cell>, IsFarther> cells;
  Cell all;
  for (int n = 0; n < 2; ++n) {
    const Interval& range = ranges_[first + n];
    all.middle[n] = 0.5 * (range.lb + range.ub);
    all.half[n] = 0.5 * (range.ub - range.lb);
  }
  if (!measure(all)) return false;
  cells.push(all);
  while (left > 0) {
    Cell cell = cells.top();
    if (cell.bound > kMeshMargin) return true;
    cells.pop();
    const int n = travel(cell, 0) > travel(cell, 1) ? 0 : 1;
    cell.half[n] *= 0.5;
    for (const double side : {-1.0, 1.0}) {
      Cell part = cell;
      part.middle[n] += side * cell.half[n];
      if (!measure(part)) return false;
      cells.push(part);
    }
  }
  return false;
}

bool touches(const Part& a, const Pose& T_B_a, const Part& b, const Pose& T_B_b) {
  coal::CollisionRequest request;
  request.security_margin = kMeshMargin;
  coal::CollisionResult result;
  return coal::collide(a.mesh.get(), transform_of(T_B_a), b.mesh.get(), transform_of(T_B_b),
                       request, result) > 0;
}

}  // namespace hg::new_files
