#include "hg/simulator/plant/bystander.h"

#include <algorithm>

namespace hg::simulator {

const BodyPart* find_body_part(std::string_view name) noexcept {
  const auto found = std::ranges::find(kBodyParts, name, &BodyPart::name);
  return found == kBodyParts.end() ? nullptr : &*found;
}

Bystander::Bystander(const BystanderConfig& config) : config_(config) {
  config_.facing.normalize();
}

Eigen::Vector3d Bystander::step(double h, const Eigen::Vector3d& p) noexcept {
  const Eigen::Vector3d from_skin = p - config_.position;
  const double along = from_skin.dot(config_.facing);
  const bool is_beside = (from_skin - along * config_.facing).norm() > config_.reach;
  const double depth = -along - pushed_;
  const bool is_met = !is_beside && depth > 0.0 && (is_in_front_ || report_.compression > 0.0);
  is_in_front_ = !is_beside && depth <= 0.0;
  report_ = {};
  if (is_met) {
    report_.compression = depth;
    report_.force = config_.part->stiffness * depth;
    report_.pressure = 1e-4 * report_.force / config_.area;
  }
  if (!config_.is_clamped) {
    speed_ += h * report_.force / config_.part->mass;
    pushed_ += h * speed_;
  }
  return report_.force * config_.facing;
}

double Bystander::energy() const noexcept {
  return 0.5 * (config_.part->mass * speed_ * speed_ + report_.force * report_.compression);
}

}  // namespace hg::simulator
