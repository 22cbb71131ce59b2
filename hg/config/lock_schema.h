/// Description of locks and conditional limits in twin.yaml.
#pragma once

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/twin_draft.h"

namespace hg::config {

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

}  // namespace hg::config
