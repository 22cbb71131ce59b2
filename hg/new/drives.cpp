#include "hg/new/drives.h"

#include <fmt/format.h>

#include <cmath>

namespace hg::new_files {
namespace {

std::string actuator_line(const DrivenJoint& driven) {
  const auto& [joint, type] = driven;
  const ActuatorModel& a = type.model;
  return fmt::format(
      "{}: {{rotor_inertia_kg_m2: {}, stiffness_Nm_per_rad: {}, damping_Nms_per_rad: {}, "
      "coulomb_friction_Nm: {}, viscous_friction_Nms_per_rad: {}, torque_max_Nm: {}, "
      "torque_rated_Nm: {}, full_torque_to_rad_per_s: {}, no_load_rad_per_s: {}}}  # [A] {}, "
      "scaled to {}\n",
      quoted(joint.name), rounded(a.rotor_inertia), rounded(a.stiffness), rounded(a.damping),
      rounded(a.coulomb_friction), rounded(a.viscous_friction), rounded(a.torque_max),
      rounded(a.torque_rated), rounded(a.speed_full_torque), rounded(a.speed_no_load), type.name,
      std::isfinite(joint.effort_max)
          ? "the effort of the URDF"
          : "weight, acceleration and a person: the URDF has no effort");
}

std::string gear_ratio_line(const std::vector<DrivenJoint>& joints) {
  std::string text;
  for (const auto& [joint, type] : joints) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", quoted(joint.name),
                        rounded(type.gear_ratio));
  }
  return "gear_ratio: {" + text + "}  # [A]\n";
}

constexpr const char* kSensorLines =
    "\nsensors:  # [A] those of the reference device, without its inertial unit\n"
    "  wrench_sensor: {force_N: [200, 200, 200], torque_Nm: [10, 10, 10]}\n";

constexpr const char* kPositionLines =
    "drives:  # [A] a position interface as most arms have it: docs/concepts/simulator.md\n"
    "  position_Hz: 10\n"
    "  speed_Hz: 50\n"
    "  latency_s: 0.004\n"
    "  actuators:\n";

constexpr const char* kTorqueLines =
    "factors:  # [A] the controller believes otherwise\n"
    "  stiffness: 0.909\n"
    "  friction: 1.333\n"
    "  mass: 1.053\n";

}  // namespace

std::string actuator_lines(const std::vector<DrivenJoint>& joints, const std::string& indent) {
  std::string text;
  for (const DrivenJoint& driven : joints) text += indent + actuator_line(driven);
  return text;
}

std::string simulation_yaml(const std::string& name, const std::vector<DrivenJoint>& joints,
                            Drives drives) {
  std::string text = fmt::format(
      "# How the simulated {} differs from what its device file says, and its sensors.\n"
      "# [A] assumed, from typical joints of models/actuators.yaml: replace it by what you know of "
      "yours.\n\n",
      name);
  if (drives == Drives::kPosition) {
    text += kPositionLines + actuator_lines(joints, "    ");
    text += "\ngears: {backlash_rad: 1e-4}  # [A]\n";
  } else {
    text += kTorqueLines;
  }
  return text + gear_ratio_line(joints) + kSensorLines;
}

}  // namespace hg::new_files
