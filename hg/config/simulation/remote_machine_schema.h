/// Description of the remote machine of a teleoperation in a scenario.
#pragma once

#include <algorithm>
#include <string>

#include "hg/config/schema.h"
#include "hg/config/simulation/protective_stop_schema.h"
#include "hg/config/simulation/teleoperation_draft.h"

namespace hg::config {

// Springs and dampers that the simulation of a machine with this mass can follow, per mass.
inline constexpr double kStiffestPerMass = 1e6;    // 1/s^2
inline constexpr double kMostDampedPerMass = 1e3;  // 1/s

/// Rules on a spring and a damper of the machine, or of what it meets.
template <class V>
void check_impedance(V& v, double stiffness, double damping, double mass, std::string_view key) {
  v.rule(stiffness <= kStiffestPerMass * mass, key, "at most 1e6 1/s^2 times what moves",
         model::to_text(stiffness) + " for " + model::to_text(mass));
  v.rule(damping <= kMostDampedPerMass * mass, key, "damping of at most 1e3 1/s times what moves",
         model::to_text(damping) + " for " + model::to_text(mass));
}

template <class V>
void describe_tool_wall(V& v, teleoperation::Wall& wall) {
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(kNoDefault), through = normal;
  v.vector("normal", normal, {.lb = -1.0, .ub = 1.0}, "tool: direction out of the wall");
  v.vector("through_m", through, {.lb = -1e3, .ub = 1e3}, "tool: a point of its surface");
  v.rule(v.is_given("normal") && v.is_given("through_m"), "",
         "a wall before a tool needs 'normal' and 'through_m'");
  v.rule(!v.is_given("normal") || normal.norm() > 1e-3, "normal", "must not be a zero vector");
  v.number("stiffness_N_per_m", wall.stiffness, kPositive, "tool: of the wall");
  v.number("damping_Ns_per_m", wall.damping, kNotNegative, "tool: of the wall");
  wall.normal = normal.normalized();
  wall.offset = wall.normal.dot(through);
}

template <class V>
void describe_joint_wall(V& v, const TeleoperationDraft& d, teleoperation::Wall& wall) {
  int joint = 0;
  double at = 0.0;
  bool is_above = false;
  v.name("joint", joint, d.joints, "a joint of the twin", "joints: which one meets the wall",
         Need::kRequired);
  v.number("at_rad", at, kAnyNumber, "joints: where it meets it", Need::kRequired);
  v.flag("is_above", is_above, "joints: the wall is at positions above, not below");
  v.number("stiffness_Nm_per_rad", wall.stiffness, kPositive, "joints: of the wall");
  v.number("damping_Nms_per_rad", wall.damping, kNotNegative, "joints: of the wall");
  const double sign = is_above ? -1.0 : 1.0;
  wall.normal = PortVector::Zero(std::min<Eigen::Index>(
      kMaxPort, std::max<Eigen::Index>(1, static_cast<Eigen::Index>(d.joints.size()))));
  if (joint < wall.normal.size()) wall.normal[joint] = sign;
  wall.offset = sign * at;
}

template <class V>
void describe_tool(V& v, TeleoperationDraft& d) {
  teleoperation::SimulatedMachineConfig& machine = d.config->machine;
  v.vector("start_m", d.tool_start, {.lb = -1e3, .ub = 1e3}, "tool: where it starts, in its base");
  v.vector("lowest_m", d.lowest, {.lb = -1e3, .ub = 1e3}, "tool: lower end of its range");
  v.vector("highest_m", d.highest, {.lb = -1e3, .ub = 1e3}, "tool: upper end of its range");
  v.rule((d.highest - d.lowest).minCoeff() > 0.0, "highest_m", "must be above lowest_m");
  const bool is_within =
      (d.tool_start - d.lowest).minCoeff() >= 0.0 && (d.highest - d.tool_start).minCoeff() >= 0.0;
  v.rule(is_within, "start_m", "the start must be within lowest_m and highest_m");
  if (v.covers(d.config->mapping == teleoperation::Mapping::kPose)) {
    v.number("turn_max_rad", d.turn_max, {.lb = 0.01, .ub = 1.75},
             "pose: largest turn from the start, about each axis");
  }
  v.number("speed_m_per_s", d.v_max, kPositive, "tool: largest speed along each axis");
  v.number("acceleration_m_per_s2", d.a_max, kPositive, "tool: largest acceleration");
  v.number("mass_kg", machine.impedance.mass, kPositive, "tool: what moves with it");
  v.number("stiffness_N_per_m", machine.impedance.stiffness, kPositive,
           "tool: of the machine's own controller");
  v.number("damping_Ns_per_m", machine.impedance.damping, kPositive,
           "tool: of the machine's own controller");
  v.number("force_max_N", machine.force_max, kPositive, "tool: largest force along each axis");
  describe_stops(v, machine.stops, kToolStops);
}

template <class V>
void describe_joints_of_machine(V& v, TeleoperationDraft& d) {
  teleoperation::SimulatedMachineConfig& machine = d.config->machine;
  v.number("speed_rad_per_s", d.v_max, kPositive, "joints: largest speed; ranges are the twin's");
  v.number("acceleration_rad_per_s2", d.a_max, kPositive, "joints: largest acceleration");
  v.number("inertia_kg_m2", machine.impedance.mass, kPositive, "joints: of each");
  v.number("stiffness_Nm_per_rad", machine.impedance.stiffness, kPositive,
           "joints: of the machine's own controller");
  v.number("damping_Nms_per_rad", machine.impedance.damping, kPositive,
           "joints: of the machine's own controller");
  v.number("torque_max_Nm", machine.force_max, kPositive, "joints: largest torque of each");
  describe_stops(v, machine.stops, kJointStops);
}

template <class V>
void describe_remote(V& v, TeleoperationDraft& d) {
  teleoperation::SimulatedMachineConfig& machine = d.config->machine;
  teleoperation::RemoteAddress& address = d.config->address;
  v.words("udp", address.udp,
          "HOST:PORT of the machine, in place of the simulated one, "
          "docs/reference/device_protocol.md");
  v.words("key_file", address.key_file, "udp: secret that the machine has, too");
  v.rule(address.key_file.empty() || !address.udp.empty(), "key_file", "needs 'udp'");
  const bool is_tool = d.config->mapping != teleoperation::Mapping::kJoints;
  const bool covers_tool = v.covers(is_tool), covers_joints = v.covers(!is_tool);
  if (covers_tool) describe_tool(v, d);
  if (covers_joints) describe_joints_of_machine(v, d);
  const double mass = machine.impedance.mass;
  const char* stiffness = is_tool ? "stiffness_N_per_m" : "stiffness_Nm_per_rad";
  check_impedance(v, machine.impedance.stiffness, machine.impedance.damping, mass, stiffness);
  v.list(
      "walls",
      [&](auto& child) {
        teleoperation::Wall& wall = machine.walls.emplace_back();
        if (covers_tool) describe_tool_wall(child, wall);
        if (covers_joints) describe_joint_wall(child, d, wall);
        check_impedance(child, wall.stiffness, wall.damping, mass, stiffness);
        if (!is_tool) return;
        child.rule(!(wall.normal.dot(d.tool_start) < wall.offset), "through_m",
                   "the tool must not start inside of it");
      },
      "what it meets");
}

}  // namespace hg::config
