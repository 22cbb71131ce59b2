#include "hg/simulator/person/intention.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hg::person {
namespace {

constexpr double kPole = 2.0 * std::numbers::pi * 3.0;  // 1/s, of an approach far from its bounds
constexpr double kFastest = 5.0;                        // m/s or rad/s, of a target at its begin
constexpr double kThere = 1e-6, kSlow = 1e-4;           // m, m/s: from here on they are one

Eigen::Vector3d shortened(const Eigen::Vector3d& v, double longest) noexcept {
  const double norm = v.norm();
  return norm > longest ? Eigen::Vector3d(longest / norm * v) : v;
}

}  // namespace

Eigen::Vector3d Approach::step(const Eigen::Vector3d& way, double dt) noexcept {
  const Eigen::Vector3d v_seen = way / dt, change = v_seen - v_target_;
  const double most = std::exchange(is_fresh_, false) ? kFastest : bounds_.jump * dt;
  const bool jumps = !(change.norm() <= most);
  if (is_there_ && !jumps) {
    v_ = v_target_ = v_seen;
    return v_;
  }
  v_target_ += shortened(change, bounds_.acceleration * dt);
  rest_ -= way;
  const double left = rest_.norm();
  // slow enough to stop in time, with half of the acceleration
  const double speed =
      std::min({0.5 * kPole * left, std::sqrt(bounds_.acceleration * left), bounds_.speed});
  Eigen::Vector3d wanted = v_target_;
  if (left > 0.0) wanted -= speed / left * rest_;
  v_ += shortened(2.0 * kPole * dt * (wanted - v_), bounds_.acceleration * dt);
  rest_ += dt * v_;
  is_there_ = !jumps && rest_.norm() < kThere && (v_ - v_seen).norm() < kSlow;
  if (is_there_) {
    rest_.setZero();
    v_target_ = v_seen;
  }
  return v_;
}

}  // namespace hg::person
