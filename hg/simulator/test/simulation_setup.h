/// The simulated worlds that the tests of Simulation share.
#pragma once

#include <utility>

#include "hg/simulator/person/person.h"
#include "hg/simulator/simulation.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::simulator {

inline const model::ChainModel& device_chain() {
  static const model::ChainModel chain = haptic_giant();
  return chain;
}

inline person::Person no_person() {
  const model::ChainModel body = model::ChainModel::free_body({}, {.gravity = false});
  return {{.kind = person::PersonKind::kNone}, body, body.frame("handle"), {}};
}

/// Pulls towards HandTarget::p_B from the default grasp on.
inline person::Person mouse() {
  const model::ChainModel body = model::ChainModel::free_body({}, {.gravity = false});
  person::PersonConfig config;
  config.kind = person::PersonKind::kMouse;
  config.hand.tremor_rms = 0.0;
  return {config, body, body.frame("handle"), {}};
}

/// The slip ring joint shows its angle within one turn.
inline SensedDevice reference_sensed() {
  SensedDevice sensed;
  sensed.is_endless[0] = true;
  sensed.gear_ratio.resize(6);
  sensed.gear_ratio << 121.0, 121.0, 121.0, 121.0, 101.0, 101.0;
  sensed.torque_full_scale.resize(6);
  sensed.torque_full_scale << 176.0, 176.0, 110.0, 110.0, 40.0, 40.0;
  return sensed;
}

/// Drives that follow positions, sensors without errors.
inline SimulatorConfig ideal_world() {
  IdealPlantConfig plant;
  plant.q_m_start.resize(6);
  plant.q_m_start << 0.0, 1.5, -0.6, 1.3, 0.2, 0.4;
  plant.q_p_start = VectorP::Zero(2);
  SimulatorConfig config;
  config.plant = plant;
  config.sensed = reference_sensed();
  config.sensed.step = config.sensed.period;
  return config;
}

/// Series elastic joints at home with four steps per period, sensors without errors.
inline SimulatorConfig elastic_world() {
  SimulatorConfig config;
  config.plant = reference_config();
  config.steps = 4;
  config.latency = 1e-3;
  config.sensed = reference_sensed();
  return config;
}

inline IdealPlantConfig& ideal(SimulatorConfig& config) {
  return std::get<IdealPlantConfig>(config.plant);
}
inline PlantConfig& elastic(SimulatorConfig& config) { return std::get<PlantConfig>(config.plant); }

inline Simulation make(const SimulatorConfig& config, person::Person person = no_person()) {
  return Simulation(config, device_chain(), device_chain().frame("handle"), std::move(person));
}

/// Answers the newest sample: drives on, everything as it is.
inline CommandFrame hold(const Simulation& device) {
  CommandFrame command;
  command.sequence = device.sensors().sequence;
  command.enable = true;
  command.q_m = device.truth().q_m;
  command.dq_m = command.ddq_m = VectorM::Zero(command.q_m.size());
  command.tau_m = device.truth().tau_J;
  command.dq_p = VectorP::Zero(2);
  return command;
}

}  // namespace hg::simulator
