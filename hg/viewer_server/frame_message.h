/// Frame: present state, sent 60 times a second. See message.h for the rules.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/viewer_server/command_message.h"
#include "hg/viewer_server/frame_parts_message.h"
#include "hg/viewer_server/message.h"

namespace hg::viewer_server {

struct FrameMessage {
  std::uint64_t run = 0;
  double time_s = 0.0;
  Mode mode = Mode::kOff;
  std::string mode_text, fault, status;
  std::vector<double> q_device, q_measured, dq_device, dq_measured, tau_measured, q_twin, dq_twin;
  std::vector<double> q_gantry_target, tracking_error;
  bool is_clamped = false;
  Vec3 p_B_H{}, v_H{}, p_B_E{}, p_B_elbow{}, force{}, torque{};
  Quaternion quaternion_B_H{}, quaternion_B_E{};
  std::optional<FeltLimitMessage> felt;
  std::vector<ActiveLimitMessage> active;
  std::optional<ContactReport> contact;
  std::vector<double> limit_position;
  std::vector<std::optional<double>> limit_distance;
  HandBudget budget;
  std::optional<Singularity> singularity;
  double sync_error_mm = 0.0, sync_error_deg = 0.0, cycle_time_us = 0.0, cycle_time_max_us = 0.0;
  HandMessage hand;
  RunState run_state;
  SafetyMessage safety;
  std::uint64_t clients = 0;
  std::optional<GhostMessage> ghost;
};

template <>
inline constexpr Interface kInterface<FrameMessage> = {"Frame", "program -> page, at update_rate"};

template <typename Archive, Is<FrameMessage> T>
void fields(Archive& a, T& frame) {
  a.type("frame");
  a("run", frame.run, "number of the run, as Scene.run");
  a("time_s", frame.time_s);
  a("mode", frame.mode);
  a("mode_text", frame.mode_text, "mode and its cause as text");
  a("fault", frame.fault, "empty = none");
  a("status", frame.status, "status in one line");
  a("q_device", frame.q_device, "gantry, then reference of the manipulator, rad or m");
  a("q_measured", frame.q_measured, "gantry, then manipulator, rad or m");
  a("dq_device", frame.dq_device, "velocities of q_device, rad/s or m/s");
  a("dq_measured", frame.dq_measured, "velocities of q_measured, rad/s or m/s");
  a("tau_measured_Nm", frame.tau_measured,
    "torque sensors of the manipulator's joints; empty = none");
  a("q_twin", frame.q_twin, "coordinates of the twin, rad or m");
  a("dq_twin", frame.dq_twin,
    "velocities of the twin, rad/s or m/s; a floating joint has 6, in its own frame");
  a("q_gantry_target_m", frame.q_gantry_target, "gantry target of prepositioning");
  a("tracking_error", frame.tracking_error,
    "reference minus link side of the manipulator, rad or m");
  a("is_clamped", frame.is_clamped,
    "tracking was lost: the reference was moved back to the device");
  a("p_B_H_m", frame.p_B_H, "position of the handle, at the reference");
  a("quaternion_B_H", frame.quaternion_B_H);
  a("v_H_m_per_s", frame.v_H);
  a("p_B_E_m", frame.p_B_E, "position of the twin's end effector");
  a("quaternion_B_E", frame.quaternion_B_E);
  a("p_B_elbow_m", frame.p_B_elbow);
  a("force_N", frame.force, "force of the user on the handle, in B");
  a("torque_Nm", frame.torque);
  a("felt", frame.felt);
  a("active", frame.active, "active limits");
  a("contact", frame.contact, "null = none");
  a("limit_position", frame.limit_position,
    "positions of the limited quantities in the order of Scene.limits, rad or m");
  a("limit_distance", frame.limit_distance,
    "distance to the nearer end, with margin; null = unbounded");
  a("budget", frame.budget, "breakdown of the user's wrench");
  a("singularity", frame.singularity);
  a("sync_error_mm", frame.sync_error_mm, "distance of handle and twin");
  a("sync_error_deg", frame.sync_error_deg);
  a("cycle_time_us", frame.cycle_time_us);
  a("cycle_time_max_us", frame.cycle_time_max_us, "maximum since the last frame");
  a("hand", frame.hand);
  a("run_state", frame.run_state);
  a("safety", frame.safety);
  a("clients", frame.clients, "number of connected pages");
  a("ghost", frame.ghost);
}

}  // namespace hg::viewer_server
