/// Description of simulation.yaml.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "hg/config/device_schema.h"
#include "hg/config/schema.h"
#include "hg/config/simulation/plant_schema.h"
#include "hg/config/simulation/sensor_schema.h"
#include "hg/config/simulation/simulation.h"
#include "hg/config/simulation/simulation_draft.h"
#include "hg/config/simulation/structure_schema.h"

namespace hg::config {

template <class V>
void describe_base(V& v, SimulationDraft& draft) {
  v.path("base", draft.base, "another simulation file, with the values that are not given here");
}

/// The first part, which defines the joint names that the second uses.
template <class V>
void describe_plant(V& v, SimulationDraft& draft) {
  constexpr double kLargestSeed = 9007199254740992.0;  // 2^53: a number of YAML is exact so far
  v.number("step_s", draft.simulation.step_s, {.lb = 1e-5, .ub = 2e-3},
           "largest step of the plant; a period is divided into equal steps");
  v.number("seed", draft.seed, {.lb = 0.0, .ub = kLargestSeed},
           "of everything random: the same seed gives the same run");
  v.rule(draft.seed == std::floor(draft.seed), "seed", "must be a whole number",
         model::to_text(draft.seed));
  v.path("urdf", draft.urdf,
         "of a plant with more joints than the controller models; without it that of the device");
}

template <class V>
void describe_effects(V& v, SimulationDraft& draft, const std::vector<std::string>& gantry,
                      const std::vector<std::string>& manipulator) {
  v.group(
      "motors", [&](auto& child) { describe(child, draft.simulation.motors); },
      "of the manipulator: what the controller does not model");
  v.group(
      "gears", [&](auto& child) { describe(child, draft.simulation.gears); },
      "of the manipulator, likewise");
  std::vector<std::string> joints = gantry;
  joints.insert(joints.end(), manipulator.begin(), manipulator.end());
  draft.structure.resize(joints.size());
  v.groups_by_name(
      "structure", joints, "a joint of the device",
      [&](auto& child, int index) {
        auto& joint = draft.structure[index];
        if (!joint) joint.emplace();
        describe(child, *joint);
      },
      "what yields behind a joint, seen by no encoder: belt and frame of a gantry axis, a link");
  const bool yields =
      std::ranges::any_of(draft.structure, [](const auto& joint) { return joint.has_value(); });
  v.rule(!yields || draft.urdf.empty(), v.is_given("structure") ? "structure" : "urdf",
         "'structure' and 'urdf' exclude each other, also in a base: put the joints into that URDF "
         "and 'flexible'");
  v.groups_by_name(
      "waviness", gantry, "an axis of the gantry",
      [&](auto& child, int index) {
        draft.simulation.waviness.resize(gantry.size());
        describe(child, draft.simulation.waviness[index]);
      },
      "how belt, wheels and rail lead the gantry astray");
}

template <class V>
void describe(V& v, PositionDrives& drives, const std::vector<std::string>& manipulator) {
  v.number("position_Hz", drives.loop.position_Hz, {.lb = 0.1, .ub = 200.0},
           "bandwidth of the position loop: how fast an error vanishes");
  v.number("speed_Hz", drives.loop.speed_Hz, {.lb = 1.0, .ub = 500.0},
           "bandwidth of the speed loop inside it");
  v.rule(drives.loop.speed_Hz >= 2.0 * drives.loop.position_Hz, "speed_Hz",
         "must be at least twice position_Hz, or the two loops oscillate",
         model::to_text(drives.loop.speed_Hz));
  v.number("latency_s", drives.latency, {.lb = 0.0, .ub = 0.1},
           "from a sample to the arrival of its answer at the drives");
  v.number("current_lag_s", drives.current_lag, kNotNegative, "time constant of the current");
  v.groups_by_name(
      "actuators", manipulator, "a joint of the manipulator",
      [&](auto& child, int index) {
        drives.actuators.resize(manipulator.size());
        describe(child, drives.actuators[index]);
      },
      "motor and gear of each joint, for all or none; without them the drives are perfect");
  const bool is_incomplete = std::ranges::any_of(
      drives.actuators, [](const ActuatorModel& a) { return a.torque_max == 0.0; });
  v.rule(!is_incomplete, "actuators", "all joints of the manipulator need one");
}

template <class V>
void describe_rest(V& v, SimulationDraft& draft, const std::vector<std::string>& gantry,
                   const std::vector<std::string>& manipulator) {
  v.groups_by_name(
      "flexible", draft.joint_names, "a joint of the URDF",
      [&](auto& child, int index) {
        FlexibleDraft& joint = draft.flexible[index].emplace();
        joint.unit = draft.joint_units[index];
        describe(child, joint);
      },
      "joints of 'urdf' without a drive: bending links or frames");
  v.rule(v.is_given("urdf") || !draft.urdf.empty() || !v.is_given("flexible"), "flexible",
         "needs 'urdf': the device has no joints but those that are driven");
  v.group(
      "factors", [&](auto& child) { describe(child, draft.simulation.factors); },
      "true values over those of the device file and its URDF");
  v.group(
      "drives", [&](auto& child) { describe(child, draft.simulation.drives, manipulator); },
      "of a device without 'actuators': how they follow positions");
  v.group(
      "safety", [&](auto& child) { describe(child, draft.simulation.safety); },
      "the safety controller, docs/concepts/safety.md");
  v.group(
      "end_stops", [&](auto& child) { describe_end_stops(child, draft.simulation); },
      "buffers at the ends of all joints");
  describe_effects(v, draft, gantry, manipulator);
  VectorM& ratios = draft.simulation.gear_ratio;  // a base has given some
  if (ratios.size() != std::ssize(manipulator)) {
    ratios = per_joint(manipulator.size(), 1.0);
  }
  v.numbers_by_name(
      "gear_ratio", manipulator, "a joint of the manipulator", {.lb = 1e-3, .ub = 1e5},
      [&](int index, double ratio) { set_joint(draft.simulation.gear_ratio, index, ratio); },
      "turns of the motor per turn of the joint, 1 where not given");
  v.group(
      "sensors", [&](auto& child) { describe(child, draft.simulation.sensors); },
      "of the device; each 0 switches an effect off, and so does .inf as a range; a 'base' may "
      "have them",
      draft.base.empty() ? Need::kRequired : Need::kOptional);
}

}  // namespace hg::config
