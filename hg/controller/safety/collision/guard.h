/// Predicts when a device must brake so as not to hit itself, its gantry, its frame or the floor.
///
/// Source: [HANDBOOK] 6.4. Braking from the state (q, dq) moves each joint along
///   q_i(t) = q_i + dq_i t while t < r_i, then with the deceleration a_i to its stop
///   s_i = q_i + dq_i r_i + dq_i |dq_i| / (2 a_i),
/// with a_i of decelerations().
/// For each pair of shapes the smallest distance on that path is bounded from below. Between two
/// points of the path with distances D1 and D2 the bound is
/// (D1 + D2 - sum_i L_i |q_i(t2) - q_i(t1)|) / 2, with the levers L_i of Pair; and planes between
/// the shapes at t1 or t2 hold them apart but for the bend of the path, which shrinks with the
/// square of t2 - t1. Intervals for which the larger bound is too small are halved.
///
/// Bounds are reused in later cycles. Where the braking paths from two states differ in joint i by
/// at most e_i, a bound shrinks by at most sum_i L_i e_i per cycle. It is recomputed only when
/// little of it is left.
///
/// A cycle computes at most most_distances() distances, for the pairs with the smallest bounds
/// first. The first cycle, with the drives off, may compute that many for each pair. A pair that
/// was not recomputed and whose bound is used up counts as a collision ahead: overload brakes the
/// device and never hides a collision. Deterministic; no allocation, noexcept after set-up.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hg/controller/safety/collision/collision_config.h"
#include "hg/controller/safety/collision/distance.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"
#include "hg/signals/collision_task.h"
#include "hg/signals/state.h"

namespace hg::collision {

struct BrakingPath;  // braking_path.h

inline constexpr int kMaxPairs = 96;  ///< Largest number of watched pairs; set-up refuses more
/// Pairs that always stay farther apart than the safe distance plus this need not be watched, m.
inline constexpr double kFarEnough = 0.02;

/// Names like "link1 - forearm", one per watched pair.
std::vector<std::string> pair_names(const CollisionConfig& config);

/// How the joints brake, gantry first.
struct Braking {
  VectorPM reaction;         ///< Reaction time of each joint until it brakes, s
  VectorPM deceleration;     ///< Largest deceleration of each joint, rad/s^2 or m/s^2, > 0
  double period = 1e-3;      ///< Time between two predictions, s
  int separate = 0;          ///< Number of joints, the first ones, that brake each for itself
  VectorPM lowest, highest;  ///< Ends of each joint, rad or m; empty: none has ends
};

/// Decelerations in a stop from `q` with speeds `dq`, rad/s^2 or m/s^2. The joints slow down in one
/// proportion, so that the device stays on the line on which it moves, and the slowest of them
/// brakes with at most its own deceleration: with the times u_i = |dq_i| / A_i,
///   a_i = |dq_i| / (sum_j u_j^8)^(1/8),
/// a maximum without corners. A joint in front of an end brakes as hard as it needs there, at most
/// with 1.5 A_i.
VectorPM decelerations(const Braking& braking, const VectorPM& q, const VectorPM& dq) noexcept;

/// Largest number of distances computed in a cycle: 60 per millisecond of its `period` (s), at
/// least
/// 24. A longer cycle sees more motion, which uses up bounds, and has the time.
int most_distances(double period) noexcept;

/// Braking of the device's joints: two periods and the dead time of the drives, then the rated
/// decelerations, 10 rad/s^2 or m/s^2 without a rating, of a gantry axis `gantry` (m/s^2 or
/// rad/s^2), which brakes for itself.
Braking braking_of(const DeviceModel& device, double gantry);

struct CollisionState {
  int count = 0;                            ///< Number of watched pairs; 0 = not started
  VectorPM q, dq, deceleration;             ///< Braking path of the last cycle
  std::array<double, kMaxPairs> left{};     ///< Lower bound on the distance minus `allowed`, m
  std::array<double, kMaxPairs> allowed{};  ///< Safe distance, less for pairs that began nearer, m
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const CollisionState& state) {
  const auto& [count, q, dq, deceleration, left, allowed] = state;
  hash.mix(count, q, dq, deceleration);
  for (int i = 0; i < count; ++i) hash.mix(left[i], allowed[i]);
}

struct Prediction {
  CollisionReport report;
  bool must_brake = false;
  double allowed = 0.0;  ///< Allowed distance of the reported pair, m
  int distances = 0;     ///< Number of distances computed
};

class Guard {
 public:
  Guard() = default;
  /// Throws SetupError when too many pairs would have to be watched.
  Guard(const CollisionConfig& config, const Braking& braking, const model::ChainModel& chain);

  /// Predicts braking from `q` and `dq`. `is_powered`: the drives move the device. As long as they
  /// do not, pairs nearer than the safe distance are accepted as they are; afterwards they must
  /// not come 5 mm nearer.
  Prediction step(const VectorPM& q, const VectorPM& dq, bool is_powered,
                  CollisionState& state) noexcept;

  /// Task of the law from `q` and `dq` of its reference, for the pairs that are near in `state`:
  /// the distance beyond what they are allowed, rounded off where several are alike.
  CollisionTask keep_apart(const VectorPM& q, const VectorPM& dq,
                           const CollisionState& state) noexcept;

 private:
  struct Place {
    double time = 0.0;
    double distance = 0.0;                            ///< Of the pair, m
    Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< From `a` to `b`, in the frame of `a`
    Pose T_a_b;                                       ///< Of their frames
  };
  Place place(int pair, const model::ChainData& chain, double time) noexcept;
  double bound_between(int pair, const BrakingPath& path, const Place& from,
                       const Place& to) noexcept;

  struct Foreseen;  // nearest place of a pair on a braking path
  struct Change;    // of the distance there

  void foresee(std::span<Foreseen> near, const BrakingPath& path,
               const CollisionState& state) noexcept;
  void refine(Foreseen& best, const BrakingPath& path, double allowed) noexcept;
  Change change_at(const Foreseen& nearest, const BrakingPath& path, double share) noexcept;
  /// Poses of the frames that the shapes of a pair are fixed to, in B.
  std::array<Pose, 2> poses(int pair, const model::ChainData& chain) const noexcept;
  double distance(int pair, const model::ChainData& chain) noexcept;
  double distance(int pair, const BrakingPath& path, double time) noexcept;
  void evaluate(int pair, const BrakingPath& path, bool is_powered, int& budget,
                CollisionState& state) noexcept;
  void fade(const BrakingPath& path, CollisionState& state) noexcept;

  CollisionConfig config_;
  Braking braking_;
  std::vector<Distance> distances_;
  std::optional<model::ChainData> now_;    // at time 0 of the path; empty without shapes
  std::optional<model::ChainData> later_;  // at another time
  int most_distances_ = 0;
  std::array<double, kMaxPairs> fading_{};  // decrease of each bound since the last cycle, m
};

}  // namespace hg::collision
