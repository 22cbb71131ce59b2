/// Remote machine in a Scene, and the other side of a teleoperation in a Frame. See message.h for
/// the rules.
#pragma once

#include "hg/viewer_server/frame_parts_message.h"
#include "hg/viewer_server/message.h"
#include "hg/viewer_server/scene_teleoperation.h"
#include "hg/viewer_server/view.h"

namespace hg::viewer_server {

template <>
inline constexpr Interface kInterface<SceneAxis> = {"SceneAxis",
                                                    "a coordinate of a remote machine"};
template <>
inline constexpr Interface kInterface<SceneWall> = {"SceneWall", "a wall before a remote machine"};
template <>
inline constexpr Interface kInterface<SceneTeleoperation> = {
    "SceneTeleoperation", "the remote machine of a teleoperation"};
template <>
inline constexpr Interface kInterface<TeleoperationView> = {
    "Teleoperation", "the other side, in coordinates of the remote machine"};

template <typename Archive, Is<SceneAxis> T>
void fields(Archive& a, T& axis) {
  a("name", axis.name, "x, y, z, or a joint of the twin");
  a("min", bounded(axis.range.lb), "null = unbounded", unit::kJointPosition);
  a("max", bounded(axis.range.ub), "null = unbounded", unit::kJointPosition);
}

template <typename Archive, Is<SceneWall> T>
void fields(Archive& a, T& wall) {
  a("normal", wall.normal, "unit vector out of the wall, in coordinates of the machine",
    unit::kNone);
  a("offset", wall.offset, "position of its surface along the normal", unit::kJointPosition);
}

template <typename Archive, Is<SceneTeleoperation> T>
void fields(Archive& a, T& teleoperation) {
  a("mapping", teleoperation.mapping, "what is led: its tool, or its joints, which are the twin's");
  a("method", teleoperation.method, "method of bilateral control");
  a("link", teleoperation.link, "what is simulated of the link, in words; empty = nothing");
  a("force_scale", teleoperation.force_scale, "force on the leader over that on the machine",
    unit::kNone);
  a("p_B_root_m", teleoperation.T_B_root.p, "where its base is drawn");
  a("quaternion_B_root", quaternion(teleoperation.T_B_root.R));
  a("axes", teleoperation.axes);
  a("walls", teleoperation.walls);
}

template <typename Archive, Is<TeleoperationView> T>
void fields(Archive& a, T& view) {
  const TeleoperationReport& report = view.report;
  a("link", report.link);
  a("cause", report.cause, "why the remote machine does not follow, as it last said");
  a("is_clutch_open", view.is_clutch_open, "a page has opened the clutch");
  a("age_s", report.age, "time since the newest packet from the remote machine was sent");
  a("round_trip_s", report.round_trip, "of packets, there and back");
  a("jitter_s", report.jitter, "mean difference of the delays of two packets in a row");
  a("loss", report.loss, "share of packets from the remote machine that were lost", unit::kNone);
  a("x_target", list(report.x_leader), "where the leader wants the remote machine",
    unit::kJointPosition);
  a("x_remote", list(report.x_remote), "where it last said it was", unit::kJointPosition);
  a("f_leader", list(report.f_leader), "force on the leader, at the scale of the remote machine",
    unit::kJointTorque);
  a("f_remote", list(report.f_remote), "force of its surroundings on the remote machine",
    unit::kJointTorque);
  a("energy_leader", report.energy_leader, "net energy taken at the operator's port", unit::kJ);
  a("energy_remote", report.energy_remote, "net energy taken at the remote port", unit::kJ);
  a("dissipated", report.dissipated, "energy dissipated by the method at both ports", unit::kJ);
}

}  // namespace hg::viewer_server
