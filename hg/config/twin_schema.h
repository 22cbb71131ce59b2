/// Description of twin.yaml.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/twin.h"
#include "hg/model/cam.h"
#include "hg/model/chain_model.h"
#include "hg/signals/twin_parameter.h"

namespace hg::config {

inline constexpr auto kSurroundings = choices_of<Surroundings>();

/// Damping and friction of a floating joint, the same in all directions, and its start.
struct FloatingPart {
  std::array<double, kFloatingParameters.size()>
      values{};  ///< initial values, in the order of kFloatingParameters
  HandPose start;
};

struct TwinJoint {
  model::JointType type = model::JointType::kRevolute;
  int v_index = 0;
  JointUnit unit = JointUnit::kEither;
  rendering::TwinDof dof;
  double start = kNoDefault;
  FloatingPart floating;
};

/// Content of twin.yaml, before it becomes a Twin.
struct TwinDraft {
  std::string name;
  std::filesystem::path urdf;
  Surroundings surroundings = Surroundings::kRoom;
  bool is_free_body = false;
  model::FreeBody body;
  Eigen::Vector3d principal_inertia = Eigen::Vector3d::Constant(0.08);
  Placement placement;
  bool gravity = false;
  bool floating_root = false;
  ChainPart part;
  std::vector<model::Coupling> couplings;
  std::vector<model::ClosedLoop> loops;
  Eigen::Vector3d force_ref = Eigen::Vector3d::Zero(), torque_ref = Eigen::Vector3d::Zero();
  double mass_scale = 1.0;
  std::vector<std::string> joint_names, frame_names;
  std::vector<TwinJoint> joints;
  std::vector<std::string> scalar_names;  ///< names of the joints that are not floating
  std::vector<int> scalar_joints;         ///< indices of these in `joints`
  int end_effector = -1;
  std::vector<rendering::Lock> locks;
  std::vector<rendering::ConditionalLimit> conditional_limits;
  std::vector<rendering::CollisionSphere> spheres;

  const TwinJoint& scalar_joint(int index) const { return joints[scalar_joints[index]]; }
};

template <class V>
void describe_chain(V& v, TwinDraft& d) {
  v.words("name", d.name, "name of the twin", Need::kRequired);
  v.path("urdf", d.urdf,
         "kinematics and inertia, with limits that are the defaults of joints; "
         "together with free_body only what is drawn");
  v.choice("surroundings", d.surroundings, kSurroundings,
           "what the page draws around it, for the eye only: rings on the floor, the wall of "
           "models/twins/door, or a building site");
  d.is_free_body = v.group(
      "free_body",
      [&](auto& child) {
        child.number("mass_kg", d.body.mass, kPositive, "mass");
        child.vector("inertia_kg_m2", d.principal_inertia, kPositive,
                     "moments of inertia about the axes of the handle, at the centre of mass");
        child.vector("centre_of_mass_m", d.body.p_handle_com, kAnyNumber, "in the handle frame");
      },
      "a single rigid body: joint 'root', frame 'handle'");
  v.rule(d.is_free_body || v.is_given("urdf"), "", "a twin needs 'urdf' or 'free_body'");
  v.group(
      "placement", [&](auto& child) { describe(child, d.placement); }, "of the root link in B");
  v.flag(facts_of(Parameter::kGravity).key, d.gravity, facts_of(Parameter::kGravity).help);
  v.flag("floating_root", d.floating_root,
         "whether the root link of the URDF moves freely, by a joint 'root'");
}

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

/// Joints that follow others.
template <class V>
void describe_followers(V& v, TwinDraft& d, const UrdfParts& urdf) {
  describe_couplings(v, d.couplings, urdf);
  describe_loops(v, d.loops, urdf);
  v.list(
      "cams", [&](auto& child) { describe_cam(child, d, urdf); },
      "joints that follow others by a curve, as on a cam: valves, presses, feeders");
}

/// Range of a parameter in the terms of the descriptions.
constexpr Range range_of(const ParameterFacts& facts) {
  return {.lb = facts.range.lb,
          .ub = facts.range.ub,
          .excludes_lb = facts.excludes_lb,
          .allows_infinity = facts.no_limit != 0.0};
}

constexpr JointKey key_of(const ParameterFacts& facts) { return {facts.key, facts.length_key}; }

/// A changeable parameter of a scalar joint.
template <class V>
void describe_parameter(V& v, Parameter parameter, double& value, JointUnit unit) {
  const ParameterFacts& facts = facts_of(parameter);
  v.joint_number(key_of(facts), unit, value, range_of(facts), facts.help);
}

template <class V>
void describe_reference_wrench(V& v, Eigen::Vector3d& force, Eigen::Vector3d& torque) {
  const ParameterFacts& facts = facts_of(Parameter::kReferenceWrench);
  v.group(
      facts.key,
      [&](auto& child) {
        for (const WrenchParameter& part : kWrenchParameters) {
          child.vector(part.key, part.first_component == 0 ? force : torque, range_of(facts),
                       part.help);
        }
      },
      facts.help);
}

template <class V>
void describe_mass_scale(V& v, double& mass_scale) {
  const ParameterFacts& facts = facts_of(Parameter::kMassScale);
  v.number(facts.key, mass_scale, range_of(facts), facts.help);
}

// ---- conditional limits and locks ----

inline constexpr JointKey kLockPosition = {"position_rad", "position_m"};
inline constexpr auto kWay = choices_of<rendering::Way>();

/// Ranges of joints that must all hold.
template <class V>
void describe_conditions(V& v, const char* key, const TwinDraft& d,
                         std::vector<rendering::JointCondition>& conditions, const char* text) {
  v.groups_by_name(
      key, d.scalar_names, "a joint of the twin",
      [&](auto& child, int index) {
        const TwinJoint& joint = d.scalar_joint(index);
        Interval range;
        child.joint_number({"above_rad", "above_m"}, joint.unit, range.lb, kAnyNumber, "lower end");
        child.joint_number({"below_rad", "below_m"}, joint.unit, range.ub, kAnyNumber, "upper end");
        child.rule(range.bounded() && !range.empty(), "",
                   "the condition needs 'above' or 'below', and something between them");
        conditions.push_back({.dof = joint.v_index, .range = range});
      },
      text);
}

/// Name and joint of a lock or conditional limit; returns the joint.
template <class V, class Item>
const TwinJoint& describe_head(V& v, Item& item, const TwinDraft& d, const char* name_text,
                               const char* joint_text) {
  v.words("name", item.name, name_text, Need::kRequired);
  int index = 0;
  v.name("joint", index, d.scalar_names, "a joint of the twin", joint_text, Need::kRequired);
  const TwinJoint& joint = d.scalar_joint(index);
  item.dof = joint.v_index;
  return joint;
}

template <class V>
void describe(V& v, rendering::Lock& lock, const TwinDraft& d) {
  const TwinJoint& joint =
      describe_head(v, lock, d, "shown while it holds", "the joint that is held");
  v.joint_number(kLockPosition, joint.unit, lock.position, kAnyNumber,
                 "where it is held; of a ratchet where one tooth is");
  v.rule(joint.dof.limits.q_min <= lock.position && lock.position <= joint.dof.limits.q_max,
         kLockPosition.of(joint.unit), "must be within the limits of the joint",
         model::to_text(lock.position));
  v.joint_number(
      {"teeth_rad", "teeth_m"}, joint.unit, lock.teeth, kPositive,
      "makes it a ratchet with teeth at this distance: the joint moves one way, and back "
      "to the last tooth that it has passed");
  v.choice("free", lock.free, kWay, "the way in which a ratchet lets the joint move");
  v.rule(lock.teeth > 0.0 || !v.is_given("free"), "free",
         "is about a ratchet, which needs 'teeth'");
  describe_conditions(v, "engaged_while", d, lock.engaged_while,
                      "the lock holds while each of these joints is in its range; without it, "
                      "always");
}

inline constexpr auto kMoving = choices_of<rendering::Moving>();

template <class V>
void describe(V& v, rendering::ConditionalLimit& limit, const TwinDraft& d) {
  const TwinJoint& joint = describe_head(v, limit, d, "for people", "the joint that is limited");
  describe_positions(v, limit.limits, joint.unit);
  describe_ratings(v, limit.limits, joint.unit, Need::kOptional);
  v.choice("moving", limit.moving, kMoving, "towards which end the largest speed holds");
  describe_conditions(v, "while", d, limit.conditions,
                      "it holds while each of these joints is in its range; without it, always");
  const limits::JointLimits& l = limit.limits;
  const bool has_speed = l.dq_max < kInfinity;
  v.rule(has_speed || l.ddq_max < kInfinity || Interval{l.q_min, l.q_max}.bounded(), "",
         "a conditional limit needs a position, a speed or an acceleration");
  v.rule(limit.moving == rendering::Moving::kEitherWay || has_speed, "moving",
         "is about the largest speed, which is not given");
  const limits::JointLimits& own = joint.dof.limits;
  v.rule(l.q_min <= own.q_max && own.q_min <= l.q_max, "",
         "the positions must have something in common with the limits of the joint");
}

// ---- joints ----

inline constexpr JointKey kStart = {"start_rad", "start_m"};

/// Spring, dampers and friction of a scalar joint.
template <class V>
void describe_forces(V& v, rendering::TwinDof& dof, JointUnit unit) {
  describe_parameter(v, Parameter::kStiffness, dof.stiffness, unit);
  describe_parameter(v, Parameter::kRest, dof.rest, unit);
  describe_parameter(v, Parameter::kPreload, dof.preload, unit);
  describe_parameter(v, Parameter::kDamping, dof.damping, unit);
  describe_parameter(v, Parameter::kQuadraticDamping, dof.quadratic_damping, unit);
  describe_parameter(v, Parameter::kFriction, dof.friction, unit);
}

template <class V>
void describe(V& v, rendering::Closer& closer, const limits::JointLimits& limits, JointUnit unit) {
  v.joint_number({"torque_Nm", "force_N"}, unit, closer.torque, kNotNegative,
                 "pull at the lower limit");
  v.joint_number({"stiffness_Nm_per_rad", "stiffness_N_per_m"}, unit, closer.stiffness,
                 kNotNegative, "how much more it pulls away from there");
  v.joint_number({"speed_rad_per_s", "speed_m_per_s"}, unit, closer.speed, kPositiveOrNone,
                 "largest speed towards the lower limit");
  v.rule(std::isfinite(limits.q_min), "", "a closer needs a joint with a lower limit");
}

/// Torque and friction over position.
template <class V>
void describe(V& v, rendering::Profile& profile, JointUnit unit) {
  std::vector<rendering::ProfilePoint> points;
  double repeat = kInfinity;
  v.joint_number({"repeat_rad", "repeat_m"}, unit, repeat, kPositiveOrNone,
                 "the points begin again after this distance; without it the torque beyond them is "
                 "that of the nearest one");
  v.list(
      "points",
      [&](auto& child) {
        rendering::ProfilePoint& point = points.emplace_back();
        child.joint_number({"at_rad", "at_m"}, unit, point.q, kAnyNumber, "position",
                           Need::kRequired);
        child.joint_number({"torque_Nm", "force_N"}, unit, point.torque, kAnyNumber,
                           "pull towards smaller positions there");
        child.joint_number({"friction_Nm", "friction_N"}, unit, point.friction, kNotNegative,
                           "Coulomb friction there, besides that of the joint");
      },
      "2 .. 100, by position; between them smooth, and never beyond the two neighbours",
      Need::kRequired);
  const std::string fault = rendering::profile_fault(points, repeat);
  v.rule(fault.empty(), "points", fault);
  if (fault.empty()) profile = rendering::Profile(points, repeat);
}

/// Damping and friction of a floating joint.
template <class V>
void describe_forces(V& v, FloatingPart& part) {
  for (std::size_t i = 0; i < kFloatingParameters.size(); ++i) {
    const FloatingParameter& key = kFloatingParameters[i];
    v.number(key.key, part.values[i], range_of(facts_of(key.parameter)), key.help);
  }
}

template <class V>
void describe(V& v, FloatingPart& part) {
  describe_forces(v, part);
  v.group(
      "start",
      [&](auto& child) {
        child.number("x_m", part.start.p.x(), kAnyNumber, "in B");
        child.number("y_m", part.start.p.y(), kAnyNumber, "in B");
        child.number("z_m", part.start.p.z(), kAnyNumber, "in B");
        child.number("azimuth_rad", part.start.azimuth, kAnyNumber, "about z of B, last");
        child.number("pitch_rad", part.start.pitch, kAnyNumber, "0 = hand axis down, pi = up");
        child.number("roll_rad", part.start.roll, kAnyNumber, "about the hand axis, first");
      },
      "floating joint, pose of the end effector at the start: Rz(azimuth) Ry(pi - pitch) "
      "Rz(pi + roll)");
}

template <class V>
void describe(V& v, TwinJoint& joint) {
  rendering::TwinDof& dof = joint.dof;
  const bool is_floating = joint.type == model::JointType::kFloating;
  if (v.covers(!is_floating)) {
    describe_positions(v, dof.limits, joint.unit);
    describe_ratings(v, dof.limits, joint.unit, Need::kOptional);
    describe_forces(v, dof, joint.unit);
    v.group(
        "closer", [&](auto& child) { describe(child, dof.closer, dof.limits, joint.unit); },
        "pulls the joint towards its lower limit, and lets it close slowly");
    v.group(
        "profile", [&](auto& child) { describe(child, dof.profile, joint.unit); },
        "torque and friction over the position of the joint, besides the others: detents, gas "
        "springs, latches");
    v.joint_number(kStart, joint.unit, joint.start, kAnyNumber,
                   "position at the start; without it the allowed one nearest to 0");
    v.rule(std::isnan(joint.start) ||
               (dof.limits.q_min <= joint.start && joint.start <= dof.limits.q_max),
           kStart.of(joint.unit), "the start must be within the limits",
           model::to_text(joint.start));
  }
  if (v.covers(is_floating)) describe(v, joint.floating);
}

template <class V>
void describe(V& v, rendering::CollisionSphere& sphere, const std::vector<std::string>& links) {
  v.name("link", sphere.frame, links, "a link of the URDF", "the link that carries it",
         Need::kRequired);
  v.vector("centre_m", sphere.p, kAnyNumber, "in the frame of the link");
  v.number("radius_m", sphere.radius, kNotNegative, "of the sphere; 0 is a corner");
}

template <class V>
void describe_joints(V& v, TwinDraft& d) {
  v.name("end_effector", d.end_effector, d.frame_names, "a link of the URDF",
         "frame E, held by the user", Need::kRequired);
  v.groups_by_name(
      "joints", d.joint_names, "a joint of the twin",
      [&](auto& child, int index) { describe(child, d.joints[index]); },
      "limits, forces and start; limits, damping and friction that are not given are taken from "
      "the URDF");
  v.list(
      "collision_spheres",
      [&](auto& child) { describe(child, d.spheres.emplace_back(), d.frame_names); },
      "spheres on links of the twin that surfaces with 'contact: stop' keep out, as they keep the "
      "end effector out; at most 8");
  v.rule(d.spheres.size() <= rendering::kMaxSpheres, "collision_spheres", "at most 8 are possible");
  describe_reference_wrench(v, d.force_ref, d.torque_ref);
  describe_mass_scale(v, d.mass_scale);
  if (!v.covers(!d.scalar_joints.empty())) return;
  v.list(
      "conditional_limits",
      [&](auto& child) { describe(child, d.conditional_limits.emplace_back(), d); },
      "limits that hold under conditions, in addition to those of the joint; at most 4");
  v.rule(d.conditional_limits.size() <= rendering::kMaxConditionalLimits, "conditional_limits",
         "at most 4 are possible");
  v.list(
      "locks", [&](auto& child) { describe(child, d.locks.emplace_back(), d); },
      "joints that are held under conditions; at most 4");
  v.rule(d.locks.size() <= rendering::kMaxLocks, "locks", "at most 4 are possible");
}

}  // namespace hg::config
