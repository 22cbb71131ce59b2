/// Parts of a Frame. See message.h for the rules.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hg/signals/limit.h"
#include "hg/signals/state.h"
#include "hg/viewer_server/message.h"
#include "hg/viewer_server/view.h"

namespace hg::viewer_server {

struct FeltLimitMessage {
  int index = 0;
  std::string name, text;
  Vector6 w = Vector6::Zero();
};

struct ActiveLimitMessage {
  int index = 0;
  LimitReport report;
  std::string text;
};

/// What stops the device, and the panel.
struct SafetyMessage {
  const View& view;
};

/// Where the root link of the twin is, and how it moves.
struct TwinBaseMessage {
  TwinBase base;
};

/// Nothing of a twin whose root link rests.
std::optional<TwinBaseMessage> twin_base_message(const TwinBase& base);

std::string fault_name(const CycleRecord& record);  ///< empty = none
/// Coordinates at which the page draws the device: gantry, then reference of the manipulator.
std::vector<double> q_device(const CycleRecord& record);
std::vector<double> list(const Eigen::Ref<const Eigen::VectorXd>& vector);

template <>
inline constexpr Interface kInterface<FeltLimitMessage> = {
    "FeltLimit", "limit that the user feels most; no wrench for limits of the twin"};
template <>
inline constexpr Interface kInterface<ActiveLimitMessage> = {"ActiveLimit", "active limit"};
template <>
inline constexpr Interface kInterface<ContactReport> = {"Contact", "contact with virtual surfaces"};
template <>
inline constexpr Interface kInterface<HandBudget> = {
    "Budget", "user = inertia + damping + ... + structure + rest"};
template <>
inline constexpr Interface kInterface<Singularity> = {
    "Singularity", "distance of the manipulator from a singularity"};
template <>
inline constexpr Interface kInterface<RunState> = {"RunState",
                                                   "state of the run as set by commands"};
template <>
inline constexpr Interface kInterface<SafetyMessage> = {
    "Safety", "cause of a stop, and the panel of the simulated operator"};
template <>
inline constexpr Interface kInterface<TwinBaseMessage> = {
    "TwinBase", "pose, velocity and acceleration of the twin's root link in B"};
template <>
inline constexpr Interface kInterface<Ghost> = {"Ghost",
                                                "second recording, overlaid for comparison"};
template <typename Archive, Is<FeltLimitMessage> T>
void fields(Archive& a, T& felt) {
  a("index", felt.index, "index in Scene.limits");
  a("name", felt.name);
  a("text", felt.text, "name and side of the limit, and its force");
  fields(a, felt.w);
}

template <typename Archive, Is<ActiveLimitMessage> T>
void fields(Archive& a, T& limit) {
  a("index", limit.index, "index in Scene.limits");
  pass_some(a, limit.report, {"state", "cause", "reaction", "excess"});
  a("text", limit.text);
}

template <typename Archive, Is<SafetyMessage> T>
void fields(Archive& a, T& message) {
  const CycleRecord& record = message.view.record;
  const SafetyView& safety = message.view.safety;
  a("stop", record.stop, "kind of the present or last stop");
  a("is_autonomous", record.is_autonomous, "runs autonomously, with a free handle");
  a("fault", static_cast<int>(record.fault.code), "number of the cause; 0 = none");
  a("cause", safety.cause, "cause with value and limit; empty = none");
  a("release", safety.release, "conditions for a reset");
  a("warning", safety.warning, "rule nearest to its threshold; empty = all are far from it");
  a("emergency_stop", safety.panel.emergency_stop || !safety.stop_pressed_by.empty(),
    "an emergency stop is pressed");
  a("stop_pressed_by", safety.stop_pressed_by, "pages that pressed it, perhaps gone; 0 = script");
  pass_some(a, safety.panel, {"operator_enable", "override_key", "person_in_field"});
}

template <typename Archive, Is<TwinBaseMessage> T>
void fields(Archive& a, T& message) {
  const TwinBase& base = message.base;
  a("p_B_m", base.T_B_A.p);
  a("quaternion_B", quaternion(base.T_B_A.R));
  a("v_m_per_s", Eigen::Vector3d(base.twist.template head<3>()));
  a("omega", Eigen::Vector3d(base.twist.template tail<3>()), "", unit::kRadPerS);
  a("a", Eigen::Vector3d(base.acceleration.template head<3>()), "of its origin", unit::kMPerS2);
}

template <typename Archive, Is<Ghost> T>
void fields(Archive& a, T& ghost) {
  a("time_s", ghost.time_s, "time of its run");
  a("q_device", q_device(ghost.record), "gantry, then reference of the manipulator",
    unit::kJointPosition);
  a("q_twin", list(ghost.record.twin.q_a), "coordinates of the twin", unit::kJointPosition);
  a("twin_base", twin_base_message(ghost.twin_base), "null = its root link rests");
  a("p_B_H_m", ghost.record.T_B_H.p);
  a("force_N", Eigen::Vector3d(ghost.record.robot.w_H.template head<3>()));
}

}  // namespace hg::viewer_server
