#include "hg/config/simulation.h"

#include <algorithm>
#include <utility>

#include "hg/config/describe_simulation.h"
#include "hg/config/loader.h"
#include "hg/config/read_chain.h"

namespace hg::config {
namespace {

void take_joints(const model::Chain& chain, SimulationDraft& draft) {
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
    loader.rule(!draft.flexible[static_cast<std::size_t>(indices.back())], "flexible",
                "must not be a joint that the device drives", "'" + name + "'");
  }
  return indices;
}

// Every joint of the plant is driven or flexible.
void take_plant(Loader& loader, const SimulatedDevice& device, SimulationDraft& draft,
                const model::Chain& chain) {
  Simulation& simulation = draft.simulation;
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
  loader.rule(simulation.flexible.size() <= simulation::kMaxFlexible, "flexible",
              "at most 8 joints are possible");
  loader.rule(std::ranges::find(chain.frame_names(), device.handle) != chain.frame_names().end(),
              "urdf", "must have the handle of the device", "no link '" + device.handle + "'");
}

void check_filters(Loader& loader, const Simulation& simulation) {
  const double longest = simulation::kMaxFilterSteps * simulation.step_s;
  for (const simulation::SensorFilterConfig& filter :
       {simulation.sensors.wrench.filter, simulation.sensors.imu_filter}) {
    loader.rule(filter.average + filter.delay <= longest, "sensors",
                "window and delay of a filter must not exceed 128 steps of the plant, " +
                    model::to_text(longest) + " s",
                model::to_text(filter.average + filter.delay));
  }
}

}  // namespace

ActuatorModel actual(ActuatorModel told, const RealityFactors& factors) {
  told.stiffness *= factors.stiffness;
  told.damping *= factors.damping;
  told.coulomb_friction *= factors.friction;
  told.viscous_friction *= factors.friction;
  told.load_friction *= factors.friction;
  told.rotor_inertia *= factors.rotor_inertia;
  return told;
}

TorqueLoop actual(TorqueLoop told, const RealityFactors& factors) {
  told.latency *= factors.latency;
  told.current_lag *= factors.current_lag;
  return told;
}

DriveModel actual(DriveModel told, const RealityFactors& factors) {
  told.lag *= factors.gantry_lag;
  return told;
}

Payload actual(Payload told, const RealityFactors& factors) {
  told.mass *= factors.payload;
  told.inertia *= factors.payload;
  return told;
}

Simulation load_simulation(const std::filesystem::path& path, SourceReader& reader,
                           const SimulatedDevice& device) {
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  SimulationDraft draft;
  load_file(file, [&](Loader& loader) {
    describe_plant(loader, draft);
    std::optional<UrdfText> urdf;
    if (!draft.urdf.empty()) urdf = read_urdf(file, draft.urdf);
    if (urdf) draft.simulation.chain = read_chain(file, *urdf, device.chain);
    if (draft.simulation.chain) take_joints(*draft.simulation.chain, draft);
    file.knows_names = false;  // of a plant without URDF, of an unknown device
    describe_rest(loader, draft, device.manipulator);
    check_filters(loader, draft.simulation);
    if (draft.simulation.chain && !device.manipulator.empty() && file.faults.count() == 0) {
      take_plant(loader, device, draft, *draft.simulation.chain);
    }
  });
  draft.simulation.is_from_file = true;
  draft.simulation.seed = static_cast<std::uint64_t>(draft.seed);
  draft.simulation.sensors.seed = draft.simulation.seed;
  return std::move(draft.simulation);
}

}  // namespace hg::config
