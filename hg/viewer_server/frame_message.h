/// Frame: present state, sent 60 times a second. See message.h for the rules.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/viewer_server/command_message.h"
#include "hg/viewer_server/frame_parts_message.h"
#include "hg/viewer_server/hand_target_box.h"
#include "hg/viewer_server/limit_text.h"
#include "hg/viewer_server/message.h"
#include "hg/viewer_server/teleoperation_message.h"

namespace hg::viewer_server {

/// A view on its way to the pages.
struct FrameMessage {
  const View& view;
  const LimitCatalogue& limits;
  std::uint64_t clients = 0;
  HandHolder holder;
};

std::vector<double> joined(const Eigen::Ref<const Eigen::VectorXd>& first,
                           const Eigen::Ref<const Eigen::VectorXd>& second);
std::optional<FeltLimitMessage> felt_limit(const FrameMessage& frame);
std::vector<ActiveLimitMessage> active_limits(const FrameMessage& frame);
std::vector<double> limit_positions(const FrameMessage& frame);
std::vector<std::optional<double>> limit_distances(const FrameMessage& frame);
HandMessage hand_message(const HandTarget& hand);

template <>
inline constexpr Interface kInterface<FrameMessage> = {"Frame", "program -> page, at update_rate"};

template <typename Archive, Is<FrameMessage> T>
void fields(Archive& a, T& frame) {
  const View& view = frame.view;
  const CycleRecord& record = view.record;
  const RobotState& robot = record.robot;
  a.type("frame");
  a("run", view.run, "number of the run, as Scene.run");
  a("time_s", record.time_s);
  a("mode", record.mode);
  a("mode_text", mode_text(record), "mode and its cause as text");
  a("fault", fault_name(record), "empty = none");
  a("status", view.status_text, "status in one line");
  a("q_device", q_device(record), "gantry, then reference of the manipulator",
    unit::kJointPosition);
  a("q_measured", joined(robot.q_p, robot.q_m), "gantry, then manipulator", unit::kJointPosition);
  a("dq_device", joined(robot.dq_p, record.reference.dq_m), "velocities of q_device",
    unit::kJointSpeed);
  a("dq_measured", joined(robot.dq_p, robot.dq_m), "velocities of q_measured", unit::kJointSpeed);
  a("tau_measured_Nm", list(robot.tau_m), "torque sensors of the joints; empty = none");
  a("q_twin", list(record.twin.q_a), "coordinates of the twin", unit::kJointPosition);
  a("dq_twin", list(record.twin.dq_a),
    "velocities of the twin; a floating joint has 6, in its own frame", unit::kJointSpeed);
  a("twin_base", twin_base_message(view.twin_base), "null = its root link rests");
  a("q_gantry_target_m", list(record.q_p_target), "gantry target of prepositioning");
  a("tracking_error", list(record.tracking.error), "reference minus link side of the manipulator",
    unit::kJointPosition);
  a("is_clamped", record.tracking.is_clamped, "tracking was lost: the reference was moved back");
  a("p_B_H_m", record.T_B_H.p, "position of the handle, at the reference");
  a("quaternion_B_H", quaternion(record.T_B_H.R));
  a("v_H_m_per_s", record.v_H);
  a("p_B_E_m", record.T_B_E.p, "position of the twin's end effector");
  a("quaternion_B_E", quaternion(record.T_B_E.R));
  a("p_B_elbow_m", record.p_B_elbow);
  a("force_N", Eigen::Vector3d(robot.w_H.template head<3>()),
    "force of the user on the handle, in B");
  a("torque_Nm", Eigen::Vector3d(robot.w_H.template tail<3>()));
  a("felt", felt_limit(frame));
  a("active", active_limits(frame), "active limits");
  a("contact", record.contact.surface >= 0 ? std::optional(record.contact) : std::nullopt,
    "null = none");
  a("limit_position", limit_positions(frame),
    "positions of the limited quantities in the order of Scene.limits", unit::kJointPosition);
  a("limit_distance", limit_distances(frame),
    "distance to the nearer end, with margin; null = unbounded", unit::kJointPosition);
  a("budget", view.budget, "breakdown of the user's wrench");
  a("singularity", view.singularity);
  a("sync_error_mm", 1e3 * record.sync_error, "distance of handle and twin");
  a("sync_error_deg", record.sync_error_angle * 180.0 / M_PI);
  a("cycle_time_us", view.cycle_time_us);
  a("cycle_time_max_us", view.cycle_time_max_us, "maximum since the last frame");
  a("latency", view.latency, "delays of link, drives, sensor and page in words; empty = unknown");
  a("hand", hand_message(view.hand));
  a("hand_page", frame.holder.page, "page whose hand holds the handle; 0 = none");
  a("hand_asked_by", frame.holder.asked_by, "page that asks it for the hand; 0 = none");
  a("run_state", view.run_state);
  a("safety", SafetyMessage{view});
  a("clients", frame.clients, "number of connected pages");
  a("ghost", view.ghost);
  a("teleoperation", view.teleoperation, "null = there is no remote machine");
}

}  // namespace hg::viewer_server
