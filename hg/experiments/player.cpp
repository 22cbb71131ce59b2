#include "hg/experiments/player.h"

#include "hg/assembly/assembly.h"
#include "hg/runtime/requests.h"

namespace hg::experiments {

Player::Player(const config::Scenario& scenario)
    : scenario_(scenario),
      cycle_(assembly::make_cycle(scenario)),
      device_(assembly::make_simulated_device(scenario)),
      changes_(scenario.changes),
      end_s_(assembly::planned_duration_s(scenario)) {}

void Player::begin() {
  device_.read(sample_->sensors);
  sample_->operator_input.late_cycles = device_.late_cycles();
  sample_->operator_input.change =
      changes_.due(static_cast<double>(played_++) / scenario_.device.rate_Hz);
}

bool Player::end() {
  device_.write(sample_->command);
  sample_->operator_input.request =
      runtime::next_request(record(), cycle_.is_held(sample_->sensors), false);
  return record().time_s < end_s_ && record().mode != Mode::kFault;
}

}  // namespace hg::experiments
