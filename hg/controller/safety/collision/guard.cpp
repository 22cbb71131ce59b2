#include "hg/controller/safety/collision/guard.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/controller/safety/collision/braking_path.h"
#include "hg/core/error.h"

namespace hg::collision {
namespace {

constexpr double kApproach = 5e-3;  // m: how much nearer a pair may come that began too near
constexpr double kAhead = 6.0;      // cycles: bounds that may be used up this soon are recomputed
constexpr double kClose = 0.05;     // m: smaller bounds are recomputed in every cycle
constexpr double kLeastFading = 1e-9;  // m
constexpr int kHalvings = 16;          // largest number of pending intervals of a path

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
  require(braking.lowest.size() == braking.highest.size() &&
              (braking.lowest.size() == 0 || braking.lowest.size() == chain.nv()),
          "ends need one value per joint, or none");
  require(config.safe_distance > 0.0, "safe_distance must be positive");
}

}  // namespace

Braking braking_of(const DeviceModel& device, double gantry) {
  constexpr double kDrive = 0.010;         // s, [HANDBOOK] 6.4
  constexpr double kWithoutRating = 10.0;  // rad/s^2 or m/s^2
  const int n = device.n_p + device.n_m;
  Braking braking = {.reaction = VectorPM::Constant(n, 2.0 * device.dt() + kDrive),
                     .deceleration = VectorPM::Constant(n, gantry),
                     .period = device.dt(),
                     .separate = device.n_p,
                     .lowest = VectorPM::Constant(n, -kInfinity),
                     .highest = VectorPM::Constant(n, kInfinity)};
  for (int i = 0; i < device.n_p; ++i) {
    braking.reaction[i] = 2.0 * device.dt() + device.drive.dead_time + device.drive.lag;
  }
  for (int i = 0; i < device.n_m; ++i) {
    const limits::JointLimits& limits = device.joint_limits[i];
    if (std::isfinite(limits.ddq_max)) {
      braking.deceleration[device.n_p + i] = limits.ddq_max;
    } else {
      braking.deceleration[device.n_p + i] = kWithoutRating;
    }
    braking.lowest[device.n_p + i] = limits.q_min;
    braking.highest[device.n_p + i] = limits.q_max;
  }
  return braking;
}

namespace {

// Time in which joints come to rest that slow down in one proportion; 0 where none moves.
double braking_time(const Braking& braking, const VectorPM& dq) noexcept {
  double sum = 0.0;
  for (Eigen::Index i = braking.separate; i < dq.size(); ++i) {
    const double share = dq[i] / braking.deceleration[i];
    const double fourth = share * share * share * share;
    sum += fourth * fourth;
  }
  return std::sqrt(std::sqrt(std::sqrt(sum)));
}

}  // namespace

VectorPM decelerations(const Braking& braking, const VectorPM& q, const VectorPM& dq) noexcept {
  constexpr double kHardest = 1.5;    // times A_i, in front of an end
  constexpr double kShortest = 0.01;  // s of remaining way; nearer ends count as this far
  VectorPM result = braking.deceleration;
  const double time = braking_time(braking, dq);
  if (!(time > 0.0)) return result;
  for (Eigen::Index i = braking.separate; i < q.size(); ++i) {
    const double speed = std::abs(dq[i]);
    if (speed == 0.0) continue;
    double needed = 0.0;
    if (braking.lowest.size() > 0) {
      const double distance = dq[i] > 0.0 ? braking.highest[i] - q[i] : q[i] - braking.lowest[i];
      const double left = distance - braking.reaction[i] * speed;
      needed = 0.5 * speed * speed / std::max(left, kShortest * speed);
    }
    result[i] = std::min(std::max(speed / time, needed), kHardest * braking.deceleration[i]);
  }
  return result;
}

int most_distances(double period) noexcept { return std::max(24, static_cast<int>(60e3 * period)); }

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

std::array<Pose, 2> Guard::poses(int pair, const model::ChainData& chain) const noexcept {
  const auto pose = [&](int shape) {
    const int frame = config_.shapes[shape].frame;
    return frame < 0 ? Pose{} : chain.pose(frame);
  };
  const Pair& shapes = config_.pairs.watched[pair];
  return {pose(shapes.a), pose(shapes.b)};
}

double Guard::distance(int pair, const model::ChainData& chain) noexcept {
  const auto [T_B_a, T_B_b] = poses(pair, chain);
  return distances_[pair](T_B_a, T_B_b);
}

double Guard::distance(int pair, const BrakingPath& path, double time) noexcept {
  later_->update_poses(path.positions(time));
  return distance(pair, *later_);
}

Guard::Place Guard::place(int pair, const model::ChainData& chain, double time) noexcept {
  const auto [T_B_a, T_B_b] = poses(pair, chain);
  const Distance::Witnesses found = distances_[pair].witnesses(T_B_a, T_B_b);
  Place place = {.time = time, .distance = found.distance};
  const Eigen::Vector3d across = found.b - found.a;
  const double length = across.norm();
  place.along = length > 0.0 ? Eigen::Vector3d(T_B_a.R.transpose() * across / length)
                             : Eigen::Vector3d::Zero();
  place.T_a_b = inverse(T_B_a) * T_B_b;
  return place;
}

// The larger of two bounds: what the joints can take from the distances at both ends, and planes
// between the shapes at one end, from which points are at the other end, too, and on the line
// between but for its bend.
double Guard::bound_between(int pair, const BrakingPath& path, const Place& from,
                            const Place& to) noexcept {
  const Pair& watched = config_.pairs.watched[pair];
  const double by_travel =
      0.5 * (from.distance + to.distance - path.travel(watched, from.time, to.time));
  const Distance& shapes = distances_[pair];
  const double by_planes =
      std::max(std::min(from.distance, shapes.between_planes(from.along, to.T_a_b)),
               std::min(to.distance, shapes.between_planes(to.along, from.T_a_b)));
  return std::max(by_travel, by_planes - path.bend(watched, from.time, to.time));
}

// Depth first from the start of the path; `ends` holds the ends of pending intervals. Where the
// budget ends it early, the faded bound of the last cycle may be the better one.
void Guard::evaluate(int index, const BrakingPath& path, bool is_powered, int& budget,
                     CollisionState& state) noexcept {
  const Pair& pair = config_.pairs.watched[index];
  double& allowed = state.allowed[index];
  Place from = place(index, *now_, 0.0);
  --budget;
  const double accepted = std::min(config_.safe_distance, from.distance - kApproach);
  const double faded = state.left[index] + allowed;
  allowed = is_powered ? std::max(allowed, accepted) : accepted;

  double smallest = from.distance;
  std::array<Place, kHalvings> ends;
  int waiting = 0;
  const auto place_at = [&](double time) {
    later_->update_poses(path.positions(time));
    return place(index, *later_, time);
  };
  if (const double end = path.duration(pair); end > 0.0) {
    ends[0] = place_at(end);
    --budget;
    waiting = 1;
  }
  while (waiting > 0) {
    const Place to = ends[waiting - 1];
    const double nearer = std::min(from.distance, to.distance);
    const double bound = std::min(nearer, bound_between(index, path, from, to));
    const bool is_good = bound - allowed >= 0.5 * (nearer - allowed);
    if (is_good || nearer <= allowed || waiting == kHalvings || budget <= 0) {
      smallest = std::min(smallest, bound);
      if (smallest <= allowed) break;
      from = to;
      --waiting;
      continue;
    }
    const double middle = 0.5 * (from.time + to.time);
    ends[waiting++] = place_at(middle);
    --budget;
  }
  if (budget <= 0) smallest = std::max(smallest, faded);
  state.left[index] = smallest - allowed;
}

// Reduces each bound by the change of the path since the last cycle.
void Guard::fade(const BrakingPath& path, CollisionState& state) noexcept {
  const BrakingPath before(braking_, state.q, state.dq, state.deceleration);
  VectorPM change(path.q.size());
  for (Eigen::Index i = 0; i < change.size(); ++i) change[i] = path.most_apart(before, i);
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
  const BrakingPath path(braking_, q, dq);
  now_->update_poses(q);
  const int had_budget = state.count == count ? most_distances_ : 0;
  int budget = had_budget;
  if (state.count == count) {
    fade(path, state);
  } else {
    fading_ = {};
    for (int i = 0; i < count; ++i) {
      state.allowed[i] = is_powered ? config_.safe_distance : 0.0;
      state.left[i] = -kInfinity;
      int first_budget = most_distances_;
      evaluate(i, path, is_powered, first_budget, state);
      prediction.distances += most_distances_ - first_budget;
    }
  }
  state.count = count;
  state.q = q;
  state.dq = dq;
  state.deceleration = path.deceleration;

  std::array<bool, kMaxPairs> is_done{};
  while (budget > 1) {
    int next = -1;
    double fewest = kInfinity;  // cycles until the bound may be used up
    for (int i = 0; i < count; ++i) {
      if (is_done[i] || state.left[i] > kAhead * fading_[i] + kClose) continue;
      const double cycles = state.left[i] / std::max(fading_[i], kLeastFading);
      if (cycles >= fewest) continue;
      fewest = cycles;
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
