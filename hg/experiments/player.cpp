#include "hg/experiments/player.h"

#include "hg/core/error.h"

namespace hg::experiments {
namespace {

const config::Scenario& checked(const config::Scenario& scenario) {
  if (!scenario.panel.empty()) {
    throw SetupError("panel: only `hapticgiant run` plays an operator, leave it out here");
  }
  return scenario;
}

}  // namespace

void set_seed(config::Scenario& scenario, std::uint64_t seed) {
  scenario.device.simulation.seed = seed;
  scenario.device.simulation.sensors.seed = seed;
}

Player::Player(const config::Scenario& scenario) : session_(checked(scenario)) {}

bool Player::end() {
  session_.write();
  return !session_.is_over() && (is_stopping_ || !session_.has_played());
}

void Player::stop() noexcept {
  is_stopping_ = true;
  session_.stop();
}

}  // namespace hg::experiments
