/// Description of cams in twin.yaml.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/coupling_schema.h"
#include "hg/config/schema.h"
#include "hg/config/twin_draft.h"
#include "hg/model/cam.h"

namespace hg::config {

/// A cam becomes a coupling by a curve; one with a fault becomes none.
template <class V>
void describe_cam(V& v, TwinDraft& d, const UrdfParts& urdf) {
  model::Coupling coupling;
  const Follower pair = describe_joints_of(v, coupling, urdf);
  const bool follows =
      std::ranges::count(d.couplings, coupling.joint, &model::Coupling::joint) > 0 ||
      std::ranges::any_of(d.loops, [&](const model::ClosedLoop& loop) {
        return std::ranges::count(loop.follow, coupling.joint) > 0;
      });
  v.rule(!follows, "joint", "follows another joint already");
  std::uint32_t repeats = 0;
  v.whole(
      "repeats_per_turn", repeats, 100,
      "how often the points come in a turn of the joint that leads, which then may turn without "
      "end; 0: once, and that joint stays between the first and the last");
  v.rule(repeats == 0 || urdf.unit_of(pair.leader) != JointUnit::kLength, "repeats_per_turn",
         "the joint that leads must turn");
  std::vector<model::CamPoint> points;
  v.list(
      "points",
      [&](auto& child) {
        model::CamPoint& point = points.emplace_back();
        child.joint_number({"at_rad", "at_m"}, urdf.unit_of(pair.leader), point.leader, kAnyNumber,
                           "position of the joint that leads", Need::kRequired);
        child.joint_number({"position_rad", "position_m"}, urdf.unit_of(pair.joint), point.follower,
                           kAnyNumber, "position of the joint that follows there", Need::kRequired);
      },
      "2 .. 200, by position of the joint that leads, at least 3 where they repeat; between them a "
      "cubic spline, smooth with its slope and curvature",
      Need::kRequired);
  const double period = repeats > 0 ? 2.0 * M_PI / repeats : kInfinity;
  const std::string fault = model::cam_fault(points, period);
  v.rule(fault.empty(), "points", fault);
  if (!fault.empty() || coupling.joint.empty()) return;
  const model::Cam cam = model::make_cam(points, period);
  const Interval& limits = urdf.joints[pair.joint].position;
  v.rule(limits.contains(cam.travel.lb) && limits.contains(cam.travel.ub), "points",
         "the joint that follows must stay within its limits, " + model::to_text(limits.lb) +
             " .. " + model::to_text(limits.ub),
         model::to_text(cam.travel.lb) + " .. " + model::to_text(cam.travel.ub));
  coupling.curve = cam.curve;
  d.couplings.push_back(std::move(coupling));
}

}  // namespace hg::config
