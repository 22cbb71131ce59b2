#include "hg/scenario/assembly.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "hg/config/control_cycle.h"
#include "hg/controller/rendering/catalogue.h"
#include "hg/core/error.h"
#include "hg/scenario/start_posture.h"
#include "hg/simulator/faults/faulty_device.h"
#include "hg/simulator/simulated_device.h"
#include "hg/teleoperation/teleoperation.h"

namespace hg::scenario {
namespace {

// channels that the script leaves open begin where the handle is
void fill_in_start(const config::Scenario& scenario, const Start& start, person::Script& script) {
  std::array<double, person::kPoseChannels> pose{};
  switch (script.frame) {
    case person::ScriptFrame::kBase: {
      const config::HandPose hand = config::hand_of(start.T_B_H);
      pose = {hand.p.x(), hand.p.y(), hand.p.z(), hand.azimuth, hand.pitch, hand.roll};
      break;
    }
    case person::ScriptFrame::kCylindrical: {
      const Eigen::Vector3d p = (inverse(scenario.twin.T_B_root) * start.T_B_H).p;
      pose = {std::atan2(p.y(), p.x()), std::hypot(p.x(), p.y()), p.z()};
      break;
    }
    case person::ScriptFrame::kTwinJoints: {
      const ConfigurationA& q = scenario.twin.model.q_start;
      std::copy_n(q.data(), std::min<Eigen::Index>(q.size(), person::kPoseChannels), pose.begin());
      break;
    }
  }
  for (std::size_t i = 0; i < pose.size(); ++i) {
    if (!scenario.script.start_given[i]) script.start[i] = pose[i];
  }
}

// Ends of travel of a joint with these limits.
Interval end_stops(const config::SimulationConfig& reality, const model::Joint& joint, double q_min,
                   double q_max) {
  const bool is_slide = joint.is_slide();
  const double beyond = is_slide ? reality.stop_distance_length : reality.stop_distance_angle;
  return {q_min - beyond, q_max + beyond};
}

// Delays between a sample and the torques of the motors.
TorqueLoop torque_loop(const config::SimulatedDeviceConfig& device) {
  const config::PositionDrives& drives = device.simulation.drives;
  const bool has_loop = plant_of(device) == config::PlantKind::kPositionDrives;
  const TorqueLoop nominal =
      has_loop ? TorqueLoop{drives.latency, drives.current_lag} : device.control.loop;
  return actual(nominal, device.simulation.factors);
}

// Machine whose motors take torques, or follow positions with a controller of their own.
simulator::PlantConfig motor_plant(const config::SimulatedDeviceConfig& device, const Start& start,
                                   double step) {
  const config::SimulationConfig& reality = device.simulation;
  simulator::PlantConfig plant = {.step = step,
                                  .gantry = reality.gantry,
                                  .manipulator = reality.manipulator,
                                  .flexible = reality.flexible,
                                  .mass = reality.factors.mass,
                                  .drive = actual(device.model.drive, reality.factors),
                                  .end_stop = reality.end_stop,
                                  .waviness = reality.waviness,
                                  .seed = reality.seed,
                                  .q_p_start = start.q_p,
                                  .q_m_start = start.q_m};
  if (!reality.chain) {
    for (int i = 0; i < device.model.n_p; ++i) plant.gantry.push_back(i);
    for (int i = 0; i < device.model.n_m; ++i) plant.manipulator.push_back(device.model.n_p + i);
  }
  const std::vector<model::Joint>& joints = device.model.chain.joints();
  const std::size_t n_p = device.model.n_p;
  for (std::size_t axis = 0; axis < n_p; ++axis) {
    const Interval& limits = device.model.gantry_range[axis];
    plant.gantry_stops.push_back(end_stops(reality, joints[axis], limits.lb, limits.ub));
  }
  const bool has_loop = plant_of(device) == config::PlantKind::kPositionDrives;
  const auto& known = device.model.actuators;
  const auto& actuators = known.empty() ? reality.drives.actuators : known;
  plant.current_lag = torque_loop(device).current_lag;
  if (has_loop) plant.position_loop = reality.drives.loop;
  for (int i = 0; i < device.model.n_m; ++i) {
    plant.actuators.push_back(actual(actuators[i], reality.factors));
    plant.effects.push_back(
        effects_of(plant.actuators.back(), reality.motors, reality.gears, reality.gear_ratio[i]));
    const limits::JointLimits& limits = device.model.joint_limits[i];
    plant.end_stops.push_back(end_stops(reality, joints[n_p + i], limits.q_min, limits.q_max));
  }
  return plant;
}

// The machine of a device.
simulator::SimulatorConfig device_simulation(const config::SimulatedDeviceConfig& device,
                                             const Start& start) {
  const config::SimulationConfig& reality = device.simulation;
  const double period = device.model.dt();
  const config::PlantKind kind = plant_of(device);
  const bool has_motors = kind != config::PlantKind::kIdeal;
  simulator::SimulatorConfig config = {.sensors = reality.sensors,
                                       .has_dead_man = device.monitor.has_dead_man};
  if (has_motors) {
    config.steps = static_cast<int>(std::ceil(period / reality.step_s - 1e-9));
    config.latency = torque_loop(device).latency;
    config.plant = motor_plant(device, start, period / config.steps);
  } else {
    config.plant = simulator::IdealPlantConfig{.period = period,
                                               .drive = actual(device.model.drive, reality.factors),
                                               .q_p_start = start.q_p,
                                               .q_m_start = start.q_m};
  }
  simulator::SensedDevice& sensed = config.sensed;
  sensed.step = period / config.steps;
  sensed.period = period;
  config.safety = device.simulation.safety;
  config.safety.period = period;
  sensed.gear_ratio = reality.gear_ratio;
  sensed.T_H_S = device.model.T_H_S;
  sensed.payload = actual(device.estimation.wrench.payload, reality.factors);
  sensed.torque_full_scale = VectorM::Ones(device.model.n_m);
  sensed.has_position_drives = kind == config::PlantKind::kPositionDrives;
  const bool has_joint_sensors = kind == config::PlantKind::kTorqueDrives;
  sensed.torque_rated = VectorM::Zero(has_joint_sensors ? device.model.n_m : 0);
  for (int i = 0; i < device.model.n_m; ++i) {
    const std::size_t in_chain = device.model.n_p + i;
    sensed.is_endless[i] =
        device.model.chain.joints()[in_chain].type == model::JointType::kContinuous;
    if (!has_motors) continue;
    const ActuatorModel& actuator = std::get<simulator::PlantConfig>(config.plant).actuators[i];
    sensed.torque_full_scale[i] = actuator.torque_max;
    if (has_joint_sensors) sensed.torque_rated[i] = actuator.torque_rated;
  }
  return config;
}

// Places the bystander. Throws SetupError where the arm cannot hit anyone.
void place(const config::BystanderInTheWay& bystander, const model::ChainModel& chain,
           simulator::SimulatorConfig& simulation) {
  auto* plant = std::get_if<simulator::PlantConfig>(&simulation.plant);
  if (plant == nullptr) {
    throw SetupError(
        "bystander: only joints with motors can hit a person, here the drives are perfect: leave "
        "it out, or run with --plant elastic");
  }
  plant->bystander = bystander.config;
  plant->bystander->frame = chain.frame(bystander.hit_by);
}

simulator::Simulation simulation_of(const config::SimulatedDeviceConfig& device, const Start& start,
                                    person::Person person,
                                    const std::optional<config::BystanderInTheWay>& bystander = {},
                                    bool leaves_handle = false) {
  const bool has_motors = plant_of(device) != config::PlantKind::kIdeal;
  const model::ChainModel& chain =
      device.simulation.chain && has_motors ? *device.simulation.chain : device.model.chain;
  const std::string& handle = device.model.chain.frame_names()[device.model.handle];
  simulator::SimulatorConfig config = device_simulation(device, start);
  for (const int frame : device.estimation.units.frames) {
    config.link_units.push_back(chain.frame(device.model.chain.frame_names()[frame]));
  }
  config.sensed.link_units = static_cast<int>(config.link_units.size());
  if (bystander) place(*bystander, chain, config);
  config.leaves_handle_for_key = leaves_handle;
  return simulator::Simulation(config, chain, chain.frame(handle), std::move(person));
}

bool has_noise(const simulator::SensorsConfig& sensors) {
  return sensors.wrench.force_noise > 0.0 && sensors.wrench.torque_noise > 0.0 &&
         sensors.torque.noise > 0.0 && sensors.accelerometer.noise > 0.0 &&
         sensors.gyroscope.noise > 0.0;
}

}  // namespace

bool notices_frozen_sensors(const config::SimulatedDeviceConfig& device) {
  const bool is_noisy = !device.simulation.is_from_file || has_noise(device.simulation.sensors);
  return is_noisy && device.monitor.frozen_samples > 0.0;
}

controller::Cycle make_cycle(const config::Scenario& scenario) {
  config::DeviceConfig device = scenario.device;
  if (!notices_frozen_sensors(scenario.device)) device.monitor.frozen_samples = 0.0;
  return config::make_cycle(device, scenario.twin, scenario.surfaces,
                            faults::solver_caps_of(scenario.faults));
}

person::Person make_person(const config::Scenario& scenario, const Start& start) {
  person::PersonConfig person{scenario.person, scenario.script.hand, scenario.script.script,
                              scenario.device.simulation.seed};
  if (scenario.person == person::PersonKind::kScript) fill_in_start(scenario, start, person.script);
  return person::Person(person, scenario.twin.model.chain, scenario.twin.model.end_effector,
                        scenario.twin.T_B_root);
}

simulator::Simulation make_simulation(const config::Scenario& scenario) {
  const Start start = find_start(scenario.device, scenario.twin);
  return simulation_of(scenario.device, start, make_person(scenario, start), scenario.bystander);
}

simulator::Simulation make_simulation(const config::Scenario& scenario, const Start& start) {
  return simulation_of(scenario.device, start, make_person(scenario, start), scenario.bystander,
                       true);
}

simulator::Simulation make_unheld_simulation(const config::SimulatedDeviceConfig& device,
                                             const Start& start) {
  return simulation_of(device, start,
                       person::Person({.kind = person::PersonKind::kNone},
                                      model::ChainModel::free_body({}), 0, Pose{}));
}

std::unique_ptr<device::Device> make_simulated_device(const config::Scenario& scenario) {
  return make_simulated_device(scenario, make_simulation(scenario));
}

std::unique_ptr<device::Device> make_simulated_device(const config::Scenario& scenario,
                                                      simulator::Simulation world) {
  auto device = std::make_unique<simulator::SimulatedDevice>(std::move(world));
  if (scenario.faults.empty()) return device;
  return std::make_unique<faults::FaultyDevice>(std::move(device), scenario.faults);
}

std::unique_ptr<TwinForceSource> make_twin_force(const config::Scenario& scenario) {
  return make_twin_force(scenario, nullptr);
}

std::unique_ptr<TwinForceSource> make_twin_force(
    const config::Scenario& scenario, std::unique_ptr<teleoperation::RemoteSide> remote) {
  if (!scenario.teleoperation) return nullptr;
  if (!remote && !scenario.teleoperation->address.udp.empty()) {
    throw SetupError(
        "teleoperation.remote.udp: a machine behind a network is led by 'hapticgiant run'");
  }
  return std::make_unique<teleoperation::Teleoperation>(
      *scenario.teleoperation, scenario.twin.model.chain, scenario.twin.model.end_effector,
      scenario.device.model.dt(), std::move(remote));
}

std::unique_ptr<TwinBaseSource> make_twin_base(const config::Scenario& scenario) {
  if (!scenario.twin_motion) return nullptr;
  simulator::MovingBaseConfig config = *scenario.twin_motion;
  config.T_B_A = scenario.twin.T_B_root;
  return std::make_unique<simulator::MovingBase>(config, scenario.device.model.dt());
}

analysis::Summary make_summary(const config::Scenario& scenario) {
  auto positions = [limits = rendering::LimitPositions(scenario.device.model)](
                       const Truth& truth, std::vector<double>& values) mutable {
    limits.find(truth.q_p, truth.q_m, values);
  };
  const std::vector<ActuatorModel>& actuators = scenario.device.model.actuators;
  VectorM torque_rated(static_cast<Eigen::Index>(actuators.size()));
  for (Eigen::Index i = 0; i < torque_rated.size(); ++i) {
    torque_rated[i] = actuators[i].torque_rated;
  }
  return {scenario.limits, std::move(positions), scenario.device.model.rate_Hz, torque_rated};
}

double planned_duration_s(const config::Scenario& scenario) {
  if (scenario.person != person::PersonKind::kScript) return 0.0;
  const person::Script& script = scenario.script.script;
  return script.grasp_s + (scenario.duration_s > 0.0 ? scenario.duration_s : script.duration_s);
}

double longest_stop_s(const config::Scenario& scenario) {
  constexpr double kMargin = 0.1;
  return scenario.device.monitor.stop_time + kMargin;
}

}  // namespace hg::scenario
