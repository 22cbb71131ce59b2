#include "hg/controller/safety/collision/guard.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/core/error.h"

namespace hg::collision {
namespace {

constexpr double kApproach = 5e-3;  // m: how much nearer a pair may come that began too near
constexpr double kAhead = 20.0;     // cycles: bounds that may be used up this soon are recomputed
constexpr double kClose = 0.05;     // m: smaller bounds are recomputed in every cycle
constexpr int kHalvings = 16;       // largest number of pending intervals of a path

void check_collision(const CollisionConfig& config, const Braking& braking,
                     const model::ChainModel& chain) {
  const auto require = [](bool holds, const char* rule) {
    if (!holds) throw SetupError(std::string("collision: ") + rule);
  };
  require(braking.reaction.size() == chain.nv() && braking.deceleration.size() == chain.nv(),
          "reaction and deceleration need one value per joint");
  require(braking.reaction.allFinite() && braking.reaction.minCoeff() >= 0.0,
          "reaction must be finite and not negative");
  require(braking.deceleration.allFinite() && braking.deceleration.minCoeff() > 0.0,
          "deceleration must be finite and positive");
  require(config.safe_distance > 0.0, "safe_distance must be positive");
}

}  // namespace

// Braking with all joints at once from the state at time 0.
struct Guard::Path {
  const Braking& braking;
  const VectorPM& q;
  const VectorPM& dq;
  VectorPM stop;

  Path(const Braking& b, const VectorPM& from, const VectorPM& speed) noexcept
      : braking(b), q(from), dq(speed), stop(from) {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      stop[i] += dq[i] * (b.reaction[i] + 0.5 * std::abs(dq[i]) / b.deceleration[i]);
    }
  }

  // time until the joints that move this pair are at rest
  double duration(const Pair& pair) const noexcept {
    double longest = 0.0;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (pair.lever[i] == 0.0 || dq[i] == 0.0) continue;
      longest = std::max(longest, braking.reaction[i] + std::abs(dq[i]) / braking.deceleration[i]);
    }
    return longest;
  }

  double position(Eigen::Index i, double time) const noexcept {
    const double reaction = braking.reaction[i], deceleration = braking.deceleration[i];
    const double since = std::max(0.0, time - reaction);
    if (since * deceleration >= std::abs(dq[i])) {
      return time >= reaction ? stop[i] : q[i] + dq[i] * time;
    }
    return q[i] + dq[i] * time - std::copysign(0.5 * deceleration * since * since, dq[i]);
  }

  // bound on what the joints between `begin` and `end` may take from the distance
  double travel(const Pair& pair, double begin, double end) const noexcept {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (pair.lever[i] == 0.0) continue;
      sum += pair.lever[i] * std::abs(position(i, end) - position(i, begin));
    }
    return sum;
  }
};

Braking braking_of(const DeviceModel& device, double gantry) {
  constexpr double kDrive = 0.010;  // s, [HANDBOOK] 6.4
  const int n = device.n_p + device.n_m;
  Braking braking = {.reaction = VectorPM::Constant(n, 2.0 * device.dt() + kDrive),
                     .deceleration = VectorPM::Constant(n, gantry),
                     .period = device.dt()};
  for (int i = 0; i < device.n_p; ++i) {
    braking.reaction[i] = 2.0 * device.dt() + device.drive.dead_time + device.drive.lag;
  }
  for (int i = 0; i < device.n_m; ++i) {
    braking.deceleration[device.n_p + i] = device.joint_limits[i].ddq_max;
  }
  return braking;
}

int most_distances(double period) noexcept { return std::max(24, static_cast<int>(40e3 * period)); }

Guard::Guard(const CollisionConfig& config, const Braking& braking, const model::ChainModel& chain)
    : config_(config), braking_(braking), most_distances_(most_distances(braking.period)) {
  if (config_.pairs.watched.empty()) return;
  check_collision(config_, braking_, chain);
  if (config_.pairs.watched.size() > kMaxPairs) {
    throw SetupError("collision: " + std::to_string(config_.pairs.watched.size()) +
                     " pairs of shapes may touch, at most " + std::to_string(kMaxPairs) +
                     " can be watched; use fewer collision elements in the URDF");
  }
  for (const Pair& pair : config_.pairs.watched) {
    distances_.emplace_back(config_.shapes[pair.a], config_.shapes[pair.b]);
  }
  now_.emplace(chain);
  later_.emplace(chain);
}

std::vector<std::string> pair_names(const CollisionConfig& config) {
  std::vector<std::string> names;
  for (const Pair& pair : config.pairs.watched) {
    names.push_back(config.shapes[pair.a].name + " - " + config.shapes[pair.b].name);
  }
  return names;
}

double Guard::distance(int pair, const model::ChainData& chain) noexcept {
  const auto pose = [&](int frame) { return frame < 0 ? Pose{} : chain.pose(frame); };
  const Pair& shapes = config_.pairs.watched[pair];
  return distances_[pair](pose(config_.shapes[shapes.a].frame),
                          pose(config_.shapes[shapes.b].frame));
}

double Guard::distance(int pair, const Path& path, double time) noexcept {
  VectorPM q(path.q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = path.position(i, time);
  later_->update_poses(q);
  return distance(pair, *later_);
}

// Depth first from the start of the path; `ends` holds the ends of pending intervals.
void Guard::evaluate(int index, const Path& path, bool is_powered, int& budget,
                     CollisionState& state) noexcept {
  struct Place {
    double time, distance;
  };
  const Pair& pair = config_.pairs.watched[index];
  double& allowed = state.allowed[index];
  Place from = {0.0, distance(index, *now_)};
  --budget;
  const double accepted = std::min(config_.safe_distance, from.distance - kApproach);
  allowed = is_powered ? std::max(allowed, accepted) : accepted;

  double smallest = from.distance;
  std::array<Place, kHalvings> ends;
  int waiting = 0;
  if (const double end = path.duration(pair); end > 0.0) {
    ends[0] = {end, distance(index, path, end)};
    --budget;
    waiting = 1;
  }
  while (waiting > 0) {
    const Place to = ends[waiting - 1];
    const double nearer = std::min(from.distance, to.distance);
    const double bound = std::min(
        nearer, 0.5 * (from.distance + to.distance - path.travel(pair, from.time, to.time)));
    const bool is_good = bound - allowed >= 0.5 * (nearer - allowed);
    if (is_good || nearer <= allowed || waiting == kHalvings || budget <= 0) {
      smallest = std::min(smallest, bound);
      if (smallest <= allowed) break;
      from = to;
      --waiting;
      continue;
    }
    const double middle = 0.5 * (from.time + to.time);
    ends[waiting++] = {middle, distance(index, path, middle)};
    --budget;
  }
  state.left[index] = smallest - allowed;
}

// Reduces each bound by the change of the path since the last cycle.
void Guard::fade(const VectorPM& q, const VectorPM& stop, CollisionState& state) noexcept {
  const VectorPM change = (q - state.q).cwiseAbs().cwiseMax((stop - state.stop).cwiseAbs());
  for (std::size_t i = 0; i < config_.pairs.watched.size(); ++i) {
    fading_[i] = config_.pairs.watched[i].lever.dot(change);
    state.left[i] -= fading_[i];
  }
}

Prediction Guard::step(const VectorPM& q, const VectorPM& dq, bool is_powered,
                       CollisionState& state) noexcept {
  Prediction prediction;
  const auto count = static_cast<int>(config_.pairs.watched.size());
  if (count == 0) return prediction;
  const Path path(braking_, q, dq);
  now_->update_poses(q);
  const int had_budget = state.count == count ? most_distances_ : 0;
  int budget = had_budget;
  if (state.count == count) {
    fade(q, path.stop, state);
  } else {
    fading_ = {};
    for (int i = 0; i < count; ++i) {
      state.allowed[i] = is_powered ? config_.safe_distance : 0.0;
      int first_budget = most_distances_;
      evaluate(i, path, is_powered, first_budget, state);
      prediction.distances += most_distances_ - first_budget;
    }
  }
  state.count = count;
  state.q = q;
  state.stop = path.stop;

  std::array<bool, kMaxPairs> is_done{};
  while (budget > 1) {
    int next = -1;
    double least = 0.0;
    for (int i = 0; i < count; ++i) {
      const double soon = state.left[i] - kAhead * fading_[i] - kClose;
      if (is_done[i] || soon > least) continue;
      least = soon;
      next = i;
    }
    if (next < 0) break;
    is_done[next] = true;
    evaluate(next, path, is_powered, budget, state);
  }
  prediction.distances += had_budget - budget;

  const auto nearest = std::min_element(state.left.begin(), state.left.begin() + count);
  const std::size_t pair = nearest - state.left.begin();
  prediction.allowed = state.allowed[pair];
  prediction.report = {*nearest + prediction.allowed, static_cast<int>(pair)};
  prediction.must_brake = *nearest <= 0.0;
  return prediction;
}

}  // namespace hg::collision
