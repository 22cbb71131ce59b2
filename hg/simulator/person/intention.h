/// Where a person wants the hand to be, also when its target jumps.
///
/// A target that moves as a hand can is taken as it is. One that jumps, as those of a client or of
/// a page do with every message, is approached with bounded speed and acceleration. SI units.
/// Copyable; no allocation, noexcept.
#pragma once

#include "hg/core/types.h"

namespace hg::person {

/// Bounds of translations (m) or rotations (rad).
struct IntentionBounds {
  double jump = 100.0;        ///< acceleration from which a target jumps
  double speed = 1.0;         ///< of the approach, relative to the target
  double acceleration = 5.0;  ///< likewise
};

/// How far the intention is from its target, along three axes.
class Approach {
 public:
  explicit Approach(const IntentionBounds& bounds) noexcept : bounds_(bounds) {}

  /// The intention is where the target is; its speed may be any that is no jump.
  void start() noexcept { *this = Approach(bounds_); }
  /// The target has moved by `way` within `dt`, s, > 0. Returns the velocity of the intention.
  Eigen::Vector3d step(const Eigen::Vector3d& way, double dt) noexcept;
  /// Intention minus target; exactly zero while the target does not jump.
  const Eigen::Vector3d& rest() const noexcept { return rest_; }

 private:
  IntentionBounds bounds_;
  bool is_there_ = true, is_fresh_ = true;
  Eigen::Vector3d rest_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_ = Eigen::Vector3d::Zero();         ///< of the intention
  Eigen::Vector3d v_target_ = Eigen::Vector3d::Zero();  ///< without its jumps
};

}  // namespace hg::person
