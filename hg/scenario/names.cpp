#include "hg/scenario/names.h"

#include <cstddef>

#include "hg/controller/rendering/tasks.h"

namespace hg::scenario {
namespace {

std::vector<std::string> joint_names(const DeviceModel& device, int first, int count) {
  std::vector<std::string> names;
  for (int i = first; i < first + count; ++i) {
    names.push_back(device.chain.joints()[i].name);
  }
  return names;
}

}  // namespace

std::vector<std::string> gantry_joints(const config::DeviceConfig& device) {
  return joint_names(device.model, 0, device.model.n_p);
}

std::vector<std::string> manipulator_joints(const config::DeviceConfig& device) {
  return joint_names(device.model, device.model.n_p, device.model.n_m);
}

analysis::Names part_names(const config::Scenario& scenario) {
  return {.joints = manipulator_joints(scenario.device),
          .gantry = gantry_joints(scenario.device),
          .pairs = collision::pair_names(scenario.device.collision),
          .limits = scenario.limits};
}

analysis::RunFacts facts_of_scenario(const config::Scenario& scenario) {
  using rendering::Braking;
  using rendering::Gantry;
  const DeviceModel& device = scenario.device.model;
  const rendering::RenderingOptions& law = scenario.device.rendering;
  const Gantry gantry = rendering::leads_gantry(device, law) ? Gantry::kLaw : Gantry::kRule;
  const Braking braking =
      rendering::brakes_together(device, law) ? Braking::kTogether : Braking::kAlone;
  return {.scenario = scenario.title,
          .law = std::string(rendering::to_string(law.law)),
          .bounds = std::string(rendering::to_string(law.bounds)),
          .gantry = std::string(rendering::to_string(gantry)),
          .braking = std::string(rendering::to_string(braking))};
}

}  // namespace hg::scenario
