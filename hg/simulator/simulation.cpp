#include "hg/simulator/simulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "hg/core/error.h"

namespace hg::simulator {
namespace {

std::variant<IdealPlant, Plant> make_plant(const SimulatorConfig& config,
                                           const model::ChainModel& chain, int handle) {
  if (const auto* elastic = std::get_if<PlantConfig>(&config.plant)) {
    return Plant(*elastic, chain, handle);
  }
  return IdealPlant(std::get<IdealPlantConfig>(config.plant), chain, handle);
}

// drives off, brakes closed
CommandFrame silence(const Truth& truth) {
  CommandFrame command;
  command.q_m = truth.q_m;
  command.dq_m = command.ddq_m = VectorM::Zero(truth.q_m.size());
  command.tau_m = VectorM::Zero(truth.theta_m.size());
  command.dq_p = VectorP::Zero(truth.q_p.size());
  return command;
}

// The encoder of a joint that turns without end shows one turn: its drive goes the short way.
void go_short_way(const SensedDevice& device, const VectorM& q_m, VectorM& command) noexcept {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (Eigen::Index i = 0; i < std::min(q_m.size(), command.size()); ++i) {
    if (!device.is_endless[static_cast<std::size_t>(i)]) continue;
    command[i] += kTurn * std::nearbyint((q_m[i] - command[i]) / kTurn);
  }
}

}  // namespace

Simulation::Simulation(const SimulatorConfig& config, const model::ChainModel& chain, int handle,
                       person::Person person)
    : config_(config),
      plant_(make_plant(config, chain, handle)),
      latency_steps_(static_cast<std::uint64_t>(std::llround(config.latency / config.sensed.step))),
      sensors_(config.sensors, config.sensed),
      torque_estimate_(config.sensors.torque_estimate, config.sensed.torque_full_scale,
                       config.sensors.seed),
      safety_plc_(config.safety),
      person_(std::move(person)) {
  if (latency_steps_ > static_cast<std::uint64_t>(kMaxLatency * config_.steps)) {
    throw SetupError("simulation: latency must be at most " + std::to_string(kMaxLatency) +
                     " periods, got " + std::to_string(config_.latency) + " s");
  }
  interpolator_ = DriveInterpolator(config_.sensed.period);
  look({});
  at_work_ = silence(truth_);
  sample();
}

void Simulation::step(const CommandFrame& command, const HardwareFaults& faults) noexcept {
  faults_ = faults;
  const std::size_t slot = (first_waiting_ + waiting_count_) % waiting_.size();
  waiting_[slot] = {command, steps_ + latency_steps_};
  if (config_.sensed.has_position_drives) {
    go_short_way(config_.sensed, truth_.q_m, waiting_[slot].command.q_m);
  }
  ++waiting_count_;
  const bool is_new = command.sequence == 0 || command.sequence != last_number_;
  silent_s_ = is_new ? 0.0 : silent_s_ + config_.sensed.period;
  last_number_ = command.sequence;
  is_cut_off_ = is_cut_off_ || (at_work_.enable && silent_s_ > config_.drive_watchdog);
  const bool leaves = config_.leaves_handle_for_key && command.panel.override_key;
  has_left_handle_ = (has_left_handle_ || leaves) && !command.hand_target.active;
  for (int i = 0; i < config_.steps; ++i) {
    take_due_command();
    move(at_work_);
    ++steps_;
    look(command.hand_target);
  }
  watch_over(command.panel);
  ++frame_.sequence;
  sample();
}

// The safety controller sees its own switches and speeds, not those reported to the program.
void Simulation::watch_over(const SafetyPanel& panel) noexcept {
  safety_plc_.step({.stop_free = TwoChannels::both(!panel.emergency_stop),
                    .operator_enable = TwoChannels::both(panel.operator_enable),
                    .user_hold = TwoChannels::both(!config_.has_dead_man || is_held()),
                    .override_key = TwoChannels::both(panel.override_key),
                    .field = panel.person_in_field ? ScannerField::kSmall : ScannerField::kNone,
                    .hand_speed = truth_.twist.head<3>().norm(),
                    .gantry_speed = truth_.dq_p.norm(),
                    .drives_on = at_work_.enable,
                    .reset = panel.reset,
                    .faults = faults_});
  frame_.safety = safety_plc_.outputs();
}

void Simulation::take_due_command() noexcept {
  while (waiting_count_ > 0 && waiting_[first_waiting_].due <= steps_) {
    const CommandFrame& command = waiting_[first_waiting_].command;
    const bool is_new = command.sequence == 0 || command.sequence != at_work_.sequence;
    if (is_new) interpolator_.take({command.q_m, command.dq_m, command.ddq_m});
    at_work_ = command;
    is_cut_off_ = is_cut_off_ && at_work_.enable;
    first_waiting_ = (first_waiting_ + 1) % waiting_.size();
    --waiting_count_;
  }
}

void Simulation::move(const CommandFrame& command) noexcept {
  const bool is_on = command.enable && !is_cut_off_ && safety_plc_.has_power();
  if (auto* ideal = std::get_if<IdealPlant>(&plant_)) {
    ideal->step(command, is_on);
    return;
  }
  auto& plant = std::get<Plant>(plant_);
  PlantInput input = {.tau_command = command.tau_m,
                      .brakes_closed = !is_on,
                      .faults = faults_,
                      .dq_p_command = command.dq_p,
                      .w_H = w_H_};
  if (plant.config().position_loop && is_on) {
    if (!interpolator_.has_command()) {
      interpolator_.take({command.q_m, command.dq_m, command.ddq_m});
    }
    input.reference = interpolator_.advance(config_.sensed.step);
  }
  if (!is_on) {
    interpolator_.rest();
    input.tau_command = VectorM::Zero(truth_.q_m.size());
    input.dq_p_command = VectorP::Zero(truth_.q_p.size());
  }
  plant.step(input);
}

// The person's wrench follows from the present motion of the handle and holds until the next step;
// on an ideal plant, which no force can move, it acts at once.
void Simulation::look(const HandTarget& target) noexcept {
  truth_ = std::visit([](const auto& plant) noexcept { return plant.truth(); }, plant_);
  w_H_ = person_.wrench(time_s(), {truth_.T_B_H, truth_.twist}, target);
  if (has_left_handle_) w_H_.setZero();
  if (std::holds_alternative<IdealPlant>(plant_)) truth_.w_H = w_H_;
  if (config_.sensors.torque_estimate.is_used) {
    sensors_.observe(felt());
  } else {
    sensors_.observe(truth_);
  }
  for (std::size_t unit = 0; unit < config_.link_units.size(); ++unit) {
    const int frame = config_.link_units[unit];
    sensors_.observe(
        unit, std::visit([&](const auto& plant) noexcept { return plant.motion(frame); }, plant_));
  }
}

// What the sensors see: an arm without a force/torque sensor mistakes the user's wrench.
Truth Simulation::felt() const noexcept {
  Truth felt = truth_;
  const auto* plant = std::get_if<Plant>(&plant_);
  if (plant != nullptr) {
    felt.w_H +=
        torque_estimate_.error(plant->handle_jacobian(), truth_.dq_m, plant->carrying_torques());
  }
  return felt;
}

void Simulation::sample() noexcept {
  take_due_command();  // a command that arrives at the moment of the sample is in effect
  truth_.walker = has_left_handle_ ? WalkerReport{} : person_.walker_report(time_s());
  sensors_.sample(truth_, frame_);
  frame_.answered_sequence = at_work_.sequence;
  frame_.driver_fault = is_cut_off_ ? FaultCode::kCommandsLost : FaultCode::kNone;
  frame_.dead_man = config_.has_dead_man && is_held();
}

double Simulation::time_s() const noexcept {
  return static_cast<double>(steps_) * config_.sensed.step;
}

bool Simulation::is_held() const noexcept {
  return !has_left_handle_ && person_.is_holding(time_s());
}

}  // namespace hg::simulator
