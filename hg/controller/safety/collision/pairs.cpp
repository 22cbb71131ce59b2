#include "hg/controller/safety/collision/pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hg/controller/safety/collision/distance.h"
#include "hg/controller/safety/collision/reach_bounds.h"
#include "hg/core/random.h"
#include "hg/model/chain_data.h"

namespace hg::collision {
namespace {

constexpr int kSamples = 800;
constexpr int kStarts = 8;       // of a search: the best of so many parts of the samples
constexpr double kBeyond = 0.3;  // share of the range by which samples overshoot: more at its ends
constexpr std::uint64_t kSeed = 20240229;
constexpr double kUnlimitedSlide = 2.0;  // m, sampled of a slide without limits

struct Candidate {
  Pair pair;
  Distance distance;
  struct Nearest {
    double distance = kInfinity;
    Eigen::VectorXd q;
  };
  double smallest = kInfinity;
  double largest = -kInfinity;
  std::array<Nearest, kStarts> nearest;  // of each part of the samples
};

std::vector<Interval> sampled(const model::ChainModel& chain, std::vector<Interval> range) {
  for (std::size_t i = 0; i < range.size(); ++i) {
    const bool is_slide = chain.joints()[i].is_slide();
    const double far = is_slide ? kUnlimitedSlide : std::numbers::pi;
    if (!std::isfinite(range[i].lb)) range[i].lb = std::min(-far, range[i].ub - 2.0 * far);
    if (!std::isfinite(range[i].ub)) range[i].ub = std::max(far, range[i].lb + 2.0 * far);
  }
  return range;
}

Pose pose_of(const model::ChainData& chain, const Shape& shape) {
  return shape.frame < 0 ? Pose{} : chain.pose(shape.frame);
}

double distance_at(const Eigen::VectorXd& q, const std::vector<Shape>& shapes,
                   const Candidate& candidate, model::ChainData& chain) {
  chain.update_poses(q);
  return candidate.distance(pose_of(chain, shapes[candidate.pair.a]),
                            pose_of(chain, shapes[candidate.pair.b]));
}

void sample(const std::vector<Shape>& shapes, const std::vector<Interval>& range,
            model::ChainData& chain, std::vector<Candidate>& candidates) {
  Random random(kSeed);
  const auto uniform = [&](const Interval& interval) {
    const double beyond = std::clamp((1.0 + 2.0 * kBeyond) * random.next() - kBeyond, 0.0, 1.0);
    return interval.lb + beyond * (interval.ub - interval.lb);
  };
  Eigen::VectorXd q(chain.model().nv());
  std::vector<Pose> poses(shapes.size());
  for (int n = 0; n < kSamples; ++n) {
    for (int i = 0; i < q.size(); ++i) q[i] = uniform(range[i]);
    chain.update_poses(q);
    for (std::size_t i = 0; i < shapes.size(); ++i) poses[i] = pose_of(chain, shapes[i]);
    for (Candidate& candidate : candidates) {
      const double distance = candidate.distance(poses[candidate.pair.a], poses[candidate.pair.b]);
      candidate.largest = std::max(candidate.largest, distance);
      candidate.smallest = std::min(candidate.smallest, distance);
      Candidate::Nearest& nearest = candidate.nearest[n % kStarts];
      if (distance < nearest.distance) nearest = {distance, q};
    }
  }
}

// Searches from a good sample, joint by joint with shrinking steps, until nearer than `near`.
void search(const std::vector<Shape>& shapes, const std::vector<Interval>& range, double near,
            Candidate::Nearest best, model::ChainData& chain, Candidate& candidate) {
  constexpr int kRounds = 40;
  constexpr double kSmallest = 1e-3;  // smallest step, share of the range
  double step = 0.15;
  for (int round = 0; round < kRounds && step > kSmallest; ++round) {
    bool is_better = false;
    for (int i = 0; i < chain.model().nv(); ++i) {
      if (candidate.pair.lever[i] == 0.0) continue;
      const Interval& joint = range[i];
      for (const double direction : {-1.0, 1.0}) {
        Eigen::VectorXd q = best.q;
        q[i] = std::clamp(q[i] + direction * step * (joint.ub - joint.lb), joint.lb, joint.ub);
        const double distance = distance_at(q, shapes, candidate, chain);
        if (distance >= best.distance) continue;
        best = {distance, q};
        is_better = true;
      }
    }
    candidate.smallest = std::min(candidate.smallest, best.distance);
    if (candidate.smallest < near) return;
    if (!is_better) step *= 0.5;
  }
}

}  // namespace

Pairs choose_pairs(const std::vector<Shape>& shapes, const model::ChainModel& chain,
                   const std::vector<Interval>& range, double near) {
  Pairs pairs;
  const ReachBounds reach_bounds(chain, range);
  std::vector<Candidate> candidates;
  for (int i = 0; i < static_cast<int>(shapes.size()); ++i) {
    for (int k = i + 1; k < static_cast<int>(shapes.size()); ++k) {
      const int body_i = shapes[i].body;
      const int body_k = shapes[k].body;
      const int a = body_i <= body_k ? i : k;
      const int b = a == i ? k : i;
      const Shape& inner = shapes[a];
      const Shape& outer = shapes[b];
      if (inner.body == outer.body) continue;  // never move relative to each other
      if (outer.body - inner.body == 1 && !inner.is_surrounding) {
        pairs.excluded.push_back({a, b, Exclusion::kNeighbours, 0.0});
        continue;
      }
      candidates.push_back(
          {.pair = {a, b, reach_bounds.of(outer, inner.body)}, .distance = {inner, outer}});
    }
  }

  const std::vector<Interval> limits = sampled(chain, range);
  model::ChainData posture(chain);
  sample(shapes, limits, posture, candidates);
  for (Candidate& candidate : candidates) {
    const Pair& pair = candidate.pair;
    if (candidate.largest <= 0.0) {
      pairs.excluded.push_back({pair.a, pair.b, Exclusion::kAlways, candidate.largest});
      continue;
    }
    for (const Candidate::Nearest& start : candidate.nearest) {
      if (candidate.smallest < near) break;
      search(shapes, limits, near, start, posture, candidate);
    }
    if (candidate.smallest < near) {
      pairs.watched.push_back(pair);
    } else {
      pairs.excluded.push_back({pair.a, pair.b, Exclusion::kNever, candidate.smallest});
    }
  }
  return pairs;
}

}  // namespace hg::collision
