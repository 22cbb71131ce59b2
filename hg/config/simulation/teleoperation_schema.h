/// Description of a teleoperation in a scenario.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/simulation/change_schema.h"
#include "hg/config/simulation/remote_machine_schema.h"
#include "hg/teleoperation/teleoperation.h"

namespace hg::config {

inline constexpr auto kMappings = choices_of<teleoperation::Mapping>();
inline constexpr auto kTeleoperationMethods = choices_of<teleoperation::MethodKind>();

template <class V>
void describe(V& v, std::vector<Interval>& times) {
  Interval& time = times.emplace_back(Interval{0.0, 0.0});
  v.number("from_s", time.lb, kNotNegative, "begin", Need::kRequired);
  v.number("to_s", time.ub, kNotNegative, "end", Need::kRequired);
  v.rule(time.lb < time.ub, "to_s", "must be after from_s");
}

template <class V>
void describe(V& v, teleoperation::ChannelConfig& link) {
  constexpr Range kLongest = {.lb = 0.0, .ub = 10.0};
  v.number("delay_s", link.delay, kLongest, "least time of a packet on its way");
  v.number("jitter_s", link.jitter, kLongest, "further time, evenly distributed up to this");
  v.number("loss", link.loss, {.lb = 0.0, .ub = 1.0}, "share of packets that are lost");
  v.number("burst", link.burst, {.lb = 0.0, .ub = 1e4},
           "packets lost in a row, mean, at least 1; 0: each for itself");
  v.rule(link.burst == 0.0 || link.burst >= 1.0, "burst", "0 or at least 1");
  v.flag("keeps_order", link.keeps_order, "packets never overtake each other");
  auto seed = static_cast<std::uint32_t>(link.seed);
  v.whole("seed", seed, 1000000, "of jitter and loss");
  link.seed = seed;
  v.list(
      "outages", [&](auto& child) { describe(child, link.outages); },
      "times of the run in which everything sent is lost");
}

template <class V>
void describe(V& v, teleoperation::MethodConfig& method) {
  using teleoperation::MethodKind;
  const auto is = [&](MethodKind kind) { return v.covers(method.kind == kind); };
  v.number("leader_mass_kg", method.leader_mass, kPositive,
           "inertia that the hand feels in free motion; kg m^2 for joints");
  if (is(MethodKind::kFourChannel)) {
    v.number("coordination_N_per_m", method.coordination, kPositive,
             "four_channel: spring between both sides; Nm/rad for joints");
  }
  if (is(MethodKind::kWaveVariables)) {
    v.number("impedance_Ns_per_m", method.impedance, kPositive,
             "wave_variables: of the link; Nms/rad for joints");
  }
  if (v.covers(method.kind == MethodKind::kWaveVariables ||
               method.kind == MethodKind::kPassivityControl)) {
    v.number("correction_per_s", method.correction, kPositive,
             "wave_variables, passivity_control: rate at which the remote machine comes to where "
             "the leader is, where energy allows");
  }
  if (is(MethodKind::kModelMediated)) {
    v.number("contact_force_N", method.contact_force, kPositive,
             "model_mediated: what is a contact; Nm for joints");
    v.number("touch_force_N", method.touch_force, kPositive,
             "model_mediated: of a contact that the leader does not know yet; Nm for joints");
  }
}

template <class V>
void describe(V& v, TeleoperationDraft& d) {
  teleoperation::TeleoperationConfig& config = *d.config;
  v.choice(
      "mapping", config.mapping, kMappings,
      "tool: the end effector of the twin leads the tool of the remote machine; pose: also its "
      "orientation; joints: the twin is the model of the machine, and its joints lead those "
      "of the machine");
  v.rule(config.mapping != teleoperation::Mapping::kJoints || d.is_machine, "mapping",
         "joints needs a twin of one to seven joints, all of which turn");
  v.choice("method", config.method.kind, kTeleoperationMethods,
           "of bilateral control, docs/concepts/teleoperation.md");
  v.group(
      "link", [&](auto& child) { describe(child, config.link); },
      "between both sides, simulated, the same in both directions");
  v.number("motion_scale", config.motion_scale, {.lb = 0.01, .ub = 100.0},
           "motion of the remote machine over that of the leader");
  v.number("force_scale", config.force_scale, {.lb = 0.01, .ub = 100.0},
           "force on the leader over that on the remote machine");
  if (v.covers(config.mapping == teleoperation::Mapping::kPose)) {
    v.number("torque_scale", config.torque_scale, {.lb = 0.01, .ub = 100.0},
             "pose: torque on the leader over that on the remote machine");
    v.number("lever_m", config.lever, {.lb = 0.001, .ub = 10.0},
             "pose: turns are measured by the way of a point at this distance, so that all that is "
             "said of m and N holds for them");
  }
  v.number("yaw_rad", d.yaw, kAnyNumber, "of the leader's base in that of the remote machine");
  v.list(
      "clutch_open", [&](auto& child) { describe(child, config.clutch_open); },
      "times since the run began in which the remote machine is released and holds");
  v.number("fade_s", config.leader.fade, {.lb = 0.01, .ub = 0.2},
           "time in which the force begins and ends");
  v.number("force_max_N", config.leader.force_max, kPositive,
           "largest force on the leader, at the scale of the remote machine; Nm for joints");
  v.group(
      "parameters", [&](auto& child) { describe(child, config.method); }, "of the method");
  v.group(
      "remote", [&](auto& child) { describe_remote(child, d); },
      "the remote machine, simulated or behind a network");
}

template <class V>
void describe_teleoperation(V& v, TeleoperationDraft& d, const ChangesDraft& changes) {
  v.group(
      "teleoperation",
      [&](auto& child) {
        d.config.emplace();
        describe(child, d);
      },
      "a remote machine that follows the twin and whose forces are felt, "
      "docs/concepts/teleoperation.md");
  v.rule(!changes.concern_remote() || leads_tool(d), "changes",
         "motion_scale and force_scale need a teleoperation that leads a tool");
}

/// The teleoperation that the draft describes; empty = none.
std::optional<teleoperation::TeleoperationConfig> teleoperation_of(const TeleoperationDraft& draft);

}  // namespace hg::config
