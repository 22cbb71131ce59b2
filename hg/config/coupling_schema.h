/// Description of couplings and closed loops in twin.yaml.
#pragma once

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/model/chain_model.h"
#include "hg/model/urdf.h"

namespace hg::config {

/// Links and joints of the URDF, for the joints that follow others.
struct UrdfParts {
  std::vector<std::string> links, joint_names;
  std::vector<model::UrdfJoint> joints;  ///< by name

  /// Name of a joint; empty for -1.
  std::string name_of(int joint) const { return joint < 0 ? "" : joint_names[joint]; }
  /// Unit of the positions of a joint; kEither for -1.
  JointUnit unit_of(int joint) const {
    if (joint < 0) return JointUnit::kEither;
    return joints[joint].type == model::UrdfJointType::kPrismatic ? JointUnit::kLength
                                                                  : JointUnit::kAngle;
  }
};

/// Indices of two joints in the URDF; -1: unknown.
struct Follower {
  int joint = -1, leader = -1;
};

/// The joint that follows and the one that leads.
template <class V>
Follower describe_joints_of(V& v, model::Coupling& coupling, const UrdfParts& urdf) {
  Follower pair;
  v.name("joint", pair.joint, urdf.joint_names, "a joint of the URDF", "the joint that follows",
         Need::kRequired);
  v.name("follows", pair.leader, urdf.joint_names, "a joint of the URDF", "the joint that leads",
         Need::kRequired);
  v.rule(pair.joint < 0 || pair.joint != pair.leader, "follows", "a joint cannot follow itself");
  coupling.joint = urdf.name_of(pair.joint);
  coupling.leader = urdf.name_of(pair.leader);
  return pair;
}

template <class V>
void describe(V& v, model::Coupling& coupling, const UrdfParts& urdf) {
  const Follower pair = describe_joints_of(v, coupling, urdf);
  v.number("ratio", coupling.ratio, kRatio,
           "its speed over that of the joint that leads, in their own units, not 0");
  v.joint_number({"offset_rad", "offset_m"}, urdf.unit_of(pair.joint), coupling.offset, kAnyNumber,
                 "its position where the joint that leads is at 0");
  v.rule(coupling.ratio != 0.0, "ratio", "must not be 0");
}

template <class V>
void describe_couplings(V& v, std::vector<model::Coupling>& couplings, const UrdfParts& urdf) {
  v.list(
      "couplings", [&](auto& child) { describe(child, couplings.emplace_back(), urdf); },
      "joints that move with others, as by 'mimic' of the URDF: gears, racks; they may be beside "
      "the "
      "chain. Such a joint is none of 'joints': limits and forces are given at the joint that "
      "leads");
}

template <class V>
void describe(V& v, model::ClosedLoop& loop, const UrdfParts& urdf) {
  int link = -1, meets = -1, leader = -1;
  std::vector<int> follow;
  v.name("link", link, urdf.links, "a link of the URDF", "one end of the loop", Need::kRequired);
  v.name("meets", meets, urdf.links, "a link of the URDF",
         "the other end: the origins of both coincide", Need::kRequired);
  v.name("leads", leader, urdf.joint_names, "a joint of the URDF",
         "the joint that moves the loop; it is one of the chain to the handle", Need::kRequired);
  v.names("follow", follow, urdf.joint_names, "a joint of the URDF",
          "one to three joints that keep it closed; two for a planar linkage", Need::kRequired);
  v.rule(!v.is_given("follow") || (!follow.empty() && follow.size() <= 3), "follow",
         "one to three joints must keep the loop closed", std::to_string(follow.size()));
  if (link >= 0) loop.link = urdf.links[link];
  if (meets >= 0) loop.meets = urdf.links[meets];
  if (leader >= 0) loop.leader = urdf.joint_names[leader];
  for (const int joint : follow) loop.follow.push_back(urdf.joint_names[joint]);
}

template <class V>
void describe_loops(V& v, std::vector<model::ClosedLoop>& loops, const UrdfParts& urdf) {
  v.list(
      "loops", [&](auto& child) { describe(child, loops.emplace_back(), urdf); },
      "closed loops, such as four-bar hinges. A URDF is a tree: cut the loop at a joint and give "
      "both sides a link there. The joints that follow move with the one that leads, within its "
      "range");
}

}  // namespace hg::config
