#include "hg/studies/player.h"

#include "hg/core/error.h"
#include "hg/runtime/requests.h"
#include "hg/scenario/assembly.h"

namespace hg::studies {

void set_seed(config::Scenario& scenario, std::uint64_t seed) {
  scenario.device.simulation.seed = seed;
  scenario.device.simulation.sensors.seed = seed;
}

Player::Player(const config::Scenario& scenario)
    : scenario_(scenario),
      cycle_(scenario::make_cycle(scenario)),
      device_(scenario::make_simulated_device(scenario)),
      changes_(scenario.changes),
      end_s_(scenario::planned_duration_s(scenario)) {
  if (!scenario.panel.empty()) {
    throw SetupError("panel: only `hapticgiant run` plays an operator, leave it out here");
  }
}

void Player::begin() {
  device_.read(sample_->sensors);
  sample_->operator_input.late_cycles = 0;
  device_.spoil(sample_->operator_input);
  sample_->operator_input.change =
      changes_.due(static_cast<double>(played_++) / scenario_.device.rate_Hz);
}

bool Player::end() {
  device_.write(sample_->command);
  sample_->operator_input.request =
      runtime::next_request(record(), cycle_.is_held(sample_->sensors), false);
  return record().time_s < end_s_ && record().mode != Mode::kFault;
}

}  // namespace hg::studies
