#include "hg/config/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hg/config/file_kind.h"
#include "hg/config/loader.h"
#include "hg/config/simulation/simulation_schema.h"
#include "hg/core/error.h"
#include "hg/model/chain_data.h"

namespace hg::config {
namespace {

void take_joints(const model::ChainModel& chain, SimulationDraft& draft) {
  draft.joint_names.clear();  // of a base, which has another URDF
  draft.joint_units.clear();
  draft.flexible.clear();
  for (const model::Joint& joint : chain.joints()) {
    draft.joint_names.push_back(joint.name);
    draft.joint_units.push_back(unit_of(joint.type));
    draft.flexible.emplace_back();
  }
}

// Indices of the device's joints among those of the plant.
std::vector<int> find_joints(Loader& loader, const std::vector<std::string>& wanted,
                             SimulationDraft& draft) {
  std::vector<int> indices;
  for (const std::string& name : wanted) {
    const auto found = std::ranges::find(draft.joint_names, name);
    loader.rule(found != draft.joint_names.end(), "urdf",
                "must have all joints of the device, there is no '" + name + "'");
    if (found == draft.joint_names.end()) continue;
    indices.push_back(static_cast<int>(found - draft.joint_names.begin()));
    loader.rule(!draft.flexible[indices.back()], "flexible",
                "must not be a joint that the device drives", "'" + name + "'");
  }
  return indices;
}

// Every joint of the plant is driven or flexible.
void take_plant(Loader& loader, const SimulationTarget& device, SimulationDraft& draft,
                const model::ChainModel& chain) {
  SimulationConfig& simulation = draft.simulation;
  simulation.gantry = find_joints(loader, device.gantry, draft);
  simulation.manipulator = find_joints(loader, device.manipulator, draft);
  std::vector<int> driven = simulation.gantry;
  driven.insert(driven.end(), simulation.manipulator.begin(), simulation.manipulator.end());
  loader.rule(std::ranges::is_sorted(driven), "urdf",
              "must have the joints of the device in the same order");
  for (std::size_t i = 0; i < draft.joint_names.size(); ++i) {
    const int index = static_cast<int>(i);
    if (std::ranges::find(driven, index) != driven.end()) continue;
    const std::string named = "'" + draft.joint_names[i] + "'";
    loader.rule(chain.joints()[i].nv == 1, "urdf", "a device has no floating joints", named);
    loader.rule(draft.flexible[i].has_value(), "urdf",
                "every joint that the device does not have must be in 'flexible'", named);
    if (!draft.flexible[i]) continue;
    simulation.flexible.push_back(
        {index, draft.flexible[i]->stiffness, draft.flexible[i]->damping});
  }
  loader.rule(simulation.flexible.size() <= simulator::kMaxFlexible, "flexible",
              "at most 8 joints are possible");
  loader.rule(std::ranges::find(chain.frame_names(), device.handle) != chain.frame_names().end(),
              "urdf", "must have the handle of the device", "no link '" + device.handle + "'");
}

constexpr char kSuffix[] = "_structure";  // suffix for the name of a joint that yields

// The chain of the device with a joint where its structure yields; its stiffness from the inertia
// that it carries.
void yield(Loader& loader, LoaderFile& file, const SimulationTarget& device,
           SimulationDraft& draft) {
  std::vector<std::string> names = device.gantry;
  names.insert(names.end(), device.manipulator.begin(), device.manipulator.end());
  model::ChainOptions options = device.chain;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& joint = draft.structure[i];
    if (!joint || joint->frequency_Hz == 0.0) continue;
    options.passive.push_back({names[i], names[i] + kSuffix, {}});
    if (joint->has_axis) options.passive.back().axis = joint->axis.normalized();
  }
  loader.rule(options.passive.size() <= simulator::kMaxFlexible, "structure",
              "at most 8 joints are possible");
  if (options.passive.empty() || device.urdf.empty() || file.faults.count() > 0) return;
  const std::optional<UrdfText> urdf = read_urdf(file, device.urdf);
  if (urdf) draft.simulation.chain = read_chain(file, *urdf, options);
  if (!draft.simulation.chain) return;
  take_joints(*draft.simulation.chain, draft);
  model::ChainData chain(*draft.simulation.chain);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(chain.model().nv());
  chain.update(rest, rest);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& joint = draft.structure[i];
    if (!joint || joint->frequency_Hz == 0.0) continue;
    const int index = chain.model().joint(names[i] + kSuffix);
    const double inertia = draft.simulation.factors.mass * chain.M()(index, index);
    const double omega = 2.0 * std::numbers::pi * joint->frequency_Hz;
    draft.flexible[index] = {.unit = draft.joint_units[index],
                             .stiffness = omega * omega * inertia,
                             .damping = 2.0 * joint->damping_ratio * omega * inertia};
  }
}

void check_filters(Loader& loader, const SimulationConfig& simulation) {
  const double longest = simulator::kMaxFilterSteps * simulation.step_s;
  for (const simulator::SensorFilterConfig& filter :
       {simulation.sensors.wrench.filter, simulation.sensors.imu_filter,
        simulation.sensors.link_unit.filter}) {
    loader.rule(filter.average + filter.delay <= longest, "sensors",
                "window and delay of a filter must not exceed 128 steps of the plant, " +
                    model::to_text(longest) + " s",
                model::to_text(filter.average + filter.delay));
  }
}

}  // namespace

ActuatorModel actual(ActuatorModel nominal, const RealityFactors& factors) {
  nominal.stiffness *= factors.stiffness;
  nominal.damping *= factors.damping;
  nominal.coulomb_friction *= factors.friction;
  nominal.viscous_friction *= factors.friction;
  nominal.load_friction *= factors.friction;
  nominal.rotor_inertia *= factors.rotor_inertia;
  return nominal;
}

TorqueLoop actual(TorqueLoop nominal, const RealityFactors& factors) {
  nominal.latency *= factors.latency;
  nominal.current_lag *= factors.current_lag;
  return nominal;
}

DriveModel actual(DriveModel nominal, const RealityFactors& factors) {
  nominal.lag *= factors.gantry_lag;
  return nominal;
}

Payload actual(Payload nominal, const RealityFactors& factors) {
  nominal.mass *= factors.payload;
  nominal.inertia *= factors.payload;
  return nominal;
}

simulator::JointEffects effects_of(const ActuatorModel& actuator, const MotorEffects& motors,
                                   const GearEffects& gears, double gear_ratio) {
  simulator::JointEffects effects = {
      .cogging = motors.cogging * actuator.torque_max,
      .cogging_wave = motors.cogging_per_turn * gear_ratio,
      .ripple = motors.ripple,
      .ripple_wave = motors.ripple_per_turn * gear_ratio,
      .bristles = static_cast<int>(gears.presliding_elements),
      .backlash = gears.backlash,
      .hysteresis = gears.hysteresis * actuator.torque_max,
      .hysteresis_stiffness = gears.hysteresis * actuator.torque_max / gears.hysteresis_angle};
  if (gears.presliding > 0.0) {
    effects.bristle_stiffness = actuator.coulomb_friction / gears.presliding;
    effects.bristle_damping = 2.0 * gears.presliding_damping_ratio *
                              std::sqrt(effects.bristle_stiffness * actuator.rotor_inertia);
  }
  return effects;
}

namespace {

void load(const std::filesystem::path& path, SourceReader& reader, const SimulationTarget& device,
          bool is_base, SimulationDraft& draft);

void load_base(LoaderFile& file, const SimulationTarget& device, SimulationDraft& draft) {
  try {
    load(draft.base, file.sources, device, true, draft);
  } catch (const SetupError& error) {
    file.faults.add_all(error);
  }
}

void load(const std::filesystem::path& path, SourceReader& reader, const SimulationTarget& device,
          bool is_base, SimulationDraft& draft) {
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  load_file_of_kind(FileKind::kSimulation, file, [&](Loader& loader) {
    describe_base(loader, draft);
    const bool has_base = loader.is_given("base");
    loader.rule(!is_base || !has_base, "base", "a base must not have a base itself");
    if (has_base && !is_base && !draft.base.empty()) load_base(file, device, draft);
    describe_plant(loader, draft);
    std::optional<UrdfText> urdf;
    if (!draft.urdf.empty()) urdf = read_urdf(file, draft.urdf);
    if (urdf) draft.simulation.chain = read_chain(file, *urdf, device.chain);
    const bool is_another = loader.is_given("urdf") || draft.joint_names.empty();
    if (draft.simulation.chain && is_another) take_joints(*draft.simulation.chain, draft);
    file.knows_names = false;  // of a plant without URDF, of an unknown device
    describe_rest(loader, draft, device.gantry, device.manipulator);
    check_filters(loader, draft.simulation);
    if (is_base) return;
    loader.rule(!device.has_actuators || draft.simulation.drives.actuators.empty(),
                "drives.actuators", "the 'actuators' of this device stand in device.yaml");
    if (draft.urdf.empty()) yield(loader, file, device, draft);
    if (draft.simulation.chain && !device.manipulator.empty() && file.faults.count() == 0) {
      take_plant(loader, device, draft, *draft.simulation.chain);
    }
  });
}

}  // namespace

SimulationConfig load_simulation(const std::filesystem::path& path, SourceReader& reader,
                                 const SimulationTarget& device) {
  SimulationDraft draft;
  load(path, reader, device, false, draft);
  draft.simulation.is_from_file = true;
  draft.simulation.seed = static_cast<std::uint64_t>(draft.seed);
  draft.simulation.sensors.seed = draft.simulation.seed;
  return std::move(draft.simulation);
}

namespace {

SimulationTarget target_of(const DeviceConfig& device) {
  const DeviceModel& model = device.model;
  SimulationTarget target = {.handle = model.chain.frame_names()[model.handle],
                             .chain = device.chain_options,
                             .urdf = device.urdf,
                             .has_actuators = !device.model.actuators.empty()};
  for (int i = 0; i < model.n_p + model.n_m; ++i) {
    std::vector<std::string>& names = i < model.n_p ? target.gantry : target.manipulator;
    names.push_back(model.chain.joints()[i].name);
  }
  return target;
}

SimulationConfig ideal_simulation(const DeviceConfig& device) {
  SimulationConfig simulation;
  simulation.sensors = simulator::ideal_sensors();
  simulation.gear_ratio = VectorM::Ones(device.model.n_m);
  return simulation;
}

}  // namespace

PlantKind plant_of(const SimulatedDeviceConfig& device) noexcept {
  if (device.control.method != tracking::Method::kDrives) return PlantKind::kTorqueDrives;
  const bool is_ideal =
      device.model.actuators.empty() && device.simulation.drives.actuators.empty();
  return is_ideal ? PlantKind::kIdeal : PlantKind::kPositionDrives;
}

SimulatedDeviceConfig load_simulated_device(const std::filesystem::path& file) {
  SourceReader reader;
  return load_simulated_device(file, reader);
}

SimulatedDeviceConfig load_simulated_device(const std::filesystem::path& file,
                                            SourceReader& reader) {
  SimulatedDeviceConfig device = {load_device(file, reader), {}};
  if (device.simulation_file.empty()) {
    device.simulation = ideal_simulation(device);
  } else {
    take_simulation(device, device.simulation_file, reader);
  }
  return device;
}

void take_simulation(SimulatedDeviceConfig& device, const std::filesystem::path& file,
                     SourceReader& reader) {
  const std::size_t first_source = reader.texts().size();
  device.simulation = load_simulation(file, reader, target_of(device));
  const std::vector<SourceText> sources = reader.since(first_source);
  device.sources.insert(device.sources.end(), sources.begin(), sources.end());
}

}  // namespace hg::config
