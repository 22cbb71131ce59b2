/// Says when a device has to brake in order not to hit itself, its gantry, its frame or the floor.
///
/// Source: [HANDBOOK] 6.4. Braking from the state (q, dq) takes each joint along
///   q_i(t) = q_i + dq_i t while t < r_i, then with the deceleration A_i to its stop
///   s_i = q_i + dq_i r_i + dq_i |dq_i| / (2 A_i).
/// For each pair of shapes the smallest distance on that path is bounded from below: between two
/// places with the distances D1, D2 by (D1 + D2 - sum_i L_i |q_i(t2) - q_i(t1)|) / 2, with the
/// levers L_i of Pair; intervals for which that is not enough are halved.
/// The paths from two states differ nowhere by more than e_i = max(|q_i - q'_i|, |s_i - s'_i|), so
/// a bound found once loses at most sum_i L_i e_i from cycle to cycle and is computed anew only
/// when little of it is left.
///
/// A cycle computes at most kMaxDistances distances, for the pairs with the least left first; only
/// the first one, with the drives off, so many for each pair. What did not get its turn and has
/// nothing left counts as a collision ahead: too much work brakes the device, it never lets it
/// through. Deterministic; no allocation, noexcept after set-up.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hg/collision/distance.h"
#include "hg/collision/pairs.h"
#include "hg/core/stacked.h"
#include "hg/signals/state.h"

namespace hg::collision {

inline constexpr int kMaxPairs = 96;      ///< watched at a time; set-up refuses more
inline constexpr int kMaxDistances = 24;  ///< computed in a cycle
/// Pairs that stay so much farther apart than the safe distance need not be watched, m.
inline constexpr double kFarEnough = 0.02;

/// Set-up data.
struct Config {
  std::vector<Shape> shapes;    ///< empty: nothing is watched
  Pairs pairs;                  ///< by choose_pairs()
  VectorPM reaction;            ///< of each joint, s, until it brakes
  VectorPM deceleration;        ///< of each joint, rad/s^2 or m/s^2, > 0
  double safe_distance = 0.03;  ///< [HANDBOOK] 6.4, m
};

/// "link1 - forearm", one per watched pair.
std::vector<std::string> pair_names(const Config& config);

struct State {
  int count = 0;                            ///< pairs that are watched; 0 = not started
  VectorPM q, stop;                         ///< of the last cycle
  std::array<double, kMaxPairs> left{};     ///< bound on the distance minus `allowed`, m
  std::array<double, kMaxPairs> allowed{};  ///< the safe distance, less where it began too near, m
};

struct Prediction {
  CollisionReport report;
  bool must_brake = false;
  double allowed = 0.0;  ///< what `report.distance` fell below, m
  int distances = 0;     ///< that were computed
};

class Guard {
 public:
  Guard() = default;
  /// Throws SetupError when too many pairs would have to be watched.
  Guard(const Config& config, const model::Chain& chain);

  /// `is_moving` = the device may move by itself. As long as it does not, pairs that are nearer
  /// than the safe distance are accepted as they are: from there on they may not come 5 mm nearer.
  Prediction step(const VectorPM& q, const VectorPM& dq, bool is_moving, State& state) noexcept;

 private:
  struct Path;  // of braking

  double distance(int pair, const Path& path, double time) noexcept;
  void evaluate(int pair, const Path& path, bool is_moving, int& budget, State& state) noexcept;
  void fade(const VectorPM& q, const VectorPM& stop, State& state) noexcept;

  Config config_;
  std::vector<Distance> distances_;
  std::vector<model::Chain> chain_;         // one, or none without shapes
  std::array<double, kMaxPairs> fading_{};  // of the last cycle, m
};

}  // namespace hg::collision
