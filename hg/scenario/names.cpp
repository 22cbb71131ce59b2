#include "hg/scenario/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>

#include "hg/controller/rendering/tasks.h"
#include "hg/controller/safety/collision/guard.h"

namespace hg::scenario {
namespace {

std::vector<std::string> joint_names(const DeviceModel& device, int first, int count) {
  std::vector<std::string> names;
  for (int i = first; i < first + count; ++i) {
    names.push_back(device.chain.joints()[i].name);
  }
  return names;
}

std::vector<std::string> joint_units(const DeviceModel& device, int first, int count) {
  std::vector<std::string> units;
  for (int i = first; i < first + count; ++i) {
    units.emplace_back(device.chain.joints()[i].is_slide() ? "m" : "rad");
  }
  return units;
}

std::string plant_words(const config::SimulatedDeviceConfig& device) {
  switch (plant_of(device)) {
    case config::PlantKind::kIdeal:
      return "ideal drives, which follow every position at once";
    case config::PlantKind::kPositionDrives:
      return fmt::format(
          "position drives with motors and gears, position loop {:g} Hz, {:g} ms late",
          device.simulation.drives.loop.position_Hz, 1e3 * device.simulation.drives.latency);
    case config::PlantKind::kTorqueDrives:
      return fmt::format("torque drives with elastic joints and friction, {:g} ms late",
                         1e3 * device.control.loop.latency);
  }
  return {};
}

simulator::PerfectSensors perfect(const config::SimulatedDeviceConfig& device) {
  const bool is_motor_side = plant_of(device) == config::PlantKind::kPositionDrives;
  return perfect_sensors(device.simulation.sensors, is_motor_side);
}

std::string sensor_words(const config::SimulatedDeviceConfig& device) {
  const auto [encoders, wrench] = perfect(device);
  const bool is_estimated = device.simulation.sensors.torque_estimate.is_used;
  return fmt::format("encoders {}, {} {}", encoders ? "ideal" : "with errors",
                     is_estimated ? "wrench estimated from joint torques," : "force/torque sensor",
                     wrench ? "ideal" : "with noise, bias and delay");
}

}  // namespace

std::vector<std::string> gantry_joints(const config::DeviceConfig& device) {
  return joint_names(device.model, 0, device.model.n_p);
}

std::vector<std::string> manipulator_joints(const config::DeviceConfig& device) {
  return joint_names(device.model, device.model.n_p, device.model.n_m);
}

std::vector<std::string> gantry_units(const config::DeviceConfig& device) {
  return joint_units(device.model, 0, device.model.n_p);
}

std::vector<std::string> manipulator_units(const config::DeviceConfig& device) {
  return joint_units(device.model, device.model.n_p, device.model.n_m);
}

std::string without_device(std::string title, const std::string& device) {
  const std::string end = ", " + device;
  if (title.ends_with(end)) title.erase(title.size() - end.size());
  return title;
}

analysis::Names part_names(const config::Scenario& scenario) {
  return {.joints = manipulator_joints(scenario.device),
          .gantry = gantry_joints(scenario.device),
          .pairs = collision::pair_names(scenario.device.collision),
          .limits = scenario.limits};
}

std::string idealisation(const config::SimulatedDeviceConfig& device) {
  std::vector<std::string> parts;
  const auto [encoders, wrench] = perfect(device);
  if (plant_of(device) == config::PlantKind::kIdeal) parts.emplace_back("ideal drives");
  if (encoders) parts.emplace_back("ideal encoders");
  if (wrench) parts.emplace_back("ideal force/torque sensor");
  return fmt::format("{}", fmt::join(parts, ", "));
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
          .braking = std::string(rendering::to_string(braking)),
          .plant = plant_words(scenario.device),
          .sensors = sensor_words(scenario.device),
          .expects_events = !scenario.events.empty()};
}

}  // namespace hg::scenario
