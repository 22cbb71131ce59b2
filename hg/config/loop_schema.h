/// Description of couplings and closed loops of a URDF in twin.yaml.
#pragma once

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/model/chain_model.h"

namespace hg::config {

/// Joints of the URDF, for the couplings between them.
struct UrdfJointNames {
  std::vector<std::string> names;
  std::vector<bool> are_slides;
};

template <class V>
void describe(V& v, model::Coupling& coupling, const UrdfJointNames& joints) {
  int joint = -1, leader = -1;
  v.name("joint", joint, joints.names, "a joint of the URDF", "the joint that follows",
         Need::kRequired);
  v.name("follows", leader, joints.names, "a joint of the URDF", "the joint that leads",
         Need::kRequired);
  JointUnit unit = JointUnit::kEither;
  if (joint >= 0) unit = joints.are_slides[joint] ? JointUnit::kLength : JointUnit::kAngle;
  v.number("ratio", coupling.ratio, kRatio,
           "its speed over that of the joint that leads, in their own units, not 0");
  v.joint_number({"offset_rad", "offset_m"}, unit, coupling.offset, kAnyNumber,
                 "its position where the joint that leads is at 0");
  v.rule(coupling.ratio != 0.0, "ratio", "must not be 0");
  v.rule(joint < 0 || joint != leader, "follows", "a joint cannot follow itself");
  if (joint >= 0) coupling.joint = joints.names[joint];
  if (leader >= 0) coupling.leader = joints.names[leader];
}

template <class V>
void describe_couplings(V& v, std::vector<model::Coupling>& couplings,
                        const UrdfJointNames& joints) {
  v.list(
      "couplings", [&](auto& child) { describe(child, couplings.emplace_back(), joints); },
      "joints that move with others, as by 'mimic' of the URDF: gears, racks; they may be beside "
      "the "
      "chain. Such a joint is none of 'joints': limits and forces are given at the joint that "
      "leads");
}

template <class V>
void describe(V& v, model::ClosedLoop& loop, const std::vector<std::string>& links,
              const std::vector<std::string>& joints) {
  int link = -1, meets = -1, leader = -1;
  std::vector<int> follow;
  v.name("link", link, links, "a link of the URDF", "one end of the loop", Need::kRequired);
  v.name("meets", meets, links, "a link of the URDF", "the other end: the origins of both coincide",
         Need::kRequired);
  v.name("leads", leader, joints, "a joint of the URDF",
         "the joint that moves the loop; it is one of the chain to the handle", Need::kRequired);
  v.names("follow", follow, joints, "a joint of the URDF",
          "one to three joints that keep it closed; two for a planar linkage", Need::kRequired);
  v.rule(!v.is_given("follow") || (!follow.empty() && follow.size() <= 3), "follow",
         "one to three joints must keep the loop closed", std::to_string(follow.size()));
  if (link >= 0) loop.link = links[link];
  if (meets >= 0) loop.meets = links[meets];
  if (leader >= 0) loop.leader = joints[leader];
  for (const int joint : follow) loop.follow.push_back(joints[joint]);
}

template <class V>
void describe_loops(V& v, std::vector<model::ClosedLoop>& loops,
                    const std::vector<std::string>& links, const std::vector<std::string>& joints) {
  v.list(
      "loops", [&](auto& child) { describe(child, loops.emplace_back(), links, joints); },
      "closed loops, such as four-bar hinges. A URDF is a tree: cut the loop at a joint and give "
      "both sides a link there. The joints that follow move with the one that leads, within its "
      "range");
}

}  // namespace hg::config
