/// Scene: data that stay constant during a run. GET /scene.json. See message.h for the rules.
#pragma once

#include "hg/viewer_server/message.h"
#include "hg/viewer_server/scene_parts_message.h"
#include "hg/viewer_server/teleoperation_message.h"

namespace hg::viewer_server {

template <>
inline constexpr Interface kInterface<Scene> = {"Scene", "GET /scene.json: fixed in a run"};

template <typename Archive, Is<Scene> T>
void fields(Archive& a, T& scene) {
  a("run", scene.run, "number of the run; fetch the scene again once a Frame has another one");
  a("source", scene.source);
  a("title", scene.title);
  a("description", scene.description);
  a("rate_hz", scene.rate_hz, "rate of the control cycle");
  a("update_rate_hz", scene.update_rate_hz, "rate of frames");
  a("begin_s", scene.begin_s, "begin of a recording, in the time of its run");
  a("duration_s", scene.duration_s, "duration of a recording, or planned; 0 = open");
  a("device", scene.device);
  a("twin", scene.twin);
  a("twin_base_moves", scene.twin_base_moves, "its root link moves, as Frame.twin_base says");
  a("gantry_joints", scene.gantry_joints, "number of gantry joints, the first ones of the device");
  a("limits", limit_messages(scene.limits));
  a("floor_z_m", scene.floor_z);
  a("box", scene.box);
  a("environment", scene.environment, "surroundings of the twin");
  a("surfaces", scene.surfaces);
  a("shapes", scene.shapes, "shapes of the device, watched for collisions with itself");
  a("checkpoints", scene.checkpoints, "places that the handle is to be brought to, in order");
  a("teleoperation", scene.teleoperation, "null = there is no remote machine");
  a("choices", scene.choices);
  a("settings", scene.settings);
  a("commands", scene.commands, "accepted commands");
  a("refusal", scene.refusal, "reason for refusing other commands; empty = all are accepted");
  a("hand_stiffness_N_per_m", scene.hand_stiffness,
    "of the arm that pulls the hand to its target, along x, y, z of B");
  a("hand_force_max_N", scene.hand_force_max, "largest pull of this arm");
  a("stopping", scene.stopping, "duration and distance of a stop; empty = unknown");
}

}  // namespace hg::viewer_server
