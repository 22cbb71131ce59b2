/// Part of a sample that other tools understand, as standard ROS messages.
///
/// Frames: "base" = B, "handle" = H at the reference, "elbow" (orientation of B), "twin_end" = E.
/// ROS gives a wrench in the frame where it acts, so the user's wrench is turned from B into H; so
/// is the twist of the handle.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "hg/messages/ros_messages.h"
#include "hg/messages/run_names.h"
#include "hg/signals/state.h"

namespace hg::messages {

class ToolMessages {
 public:
  /// With `links` the transforms contain them, too.
  explicit ToolMessages(const RunNames& names, LinkTree links = {});

  /// Fills all messages. Values missing in the sample are NaN. The angular velocity of the handle
  /// is the mean since the update before, zero in the first one.
  void update(const Sample& sample, std::uint64_t time_ns);

  const JointState& device() const noexcept { return device_; }  ///< gantry, then manipulator
  const JointState& twin() const noexcept { return twin_; }      ///< joints with one coordinate
  const WrenchStamped& user_wrench() const noexcept { return user_wrench_; }
  const TwistStamped& handle_twist() const noexcept { return handle_twist_; }
  const TransformMessage& transforms() const noexcept { return transforms_; }
  /// Limits in the order of the catalogue: distance to the nearer end as position, reaction as
  /// effort.
  const JointState& limits() const noexcept { return limits_; }

  /// Passes all messages of a recording, each with its topic.
  template <typename Visitor>
  void pass_recorded(Visitor&& visit) const {
    visit("/joint_states", device_);
    visit("/twin/joint_states", twin_);
    visit("/user_wrench", user_wrench_);
    visit("/handle_twist", handle_twist_);
    visit("/tf", transforms_);
  }

 private:
  /// Index of a twin's joint in q_a, and in dq_a and tau_a.
  struct Place {
    int coordinate, velocity;
  };

  void update_joints(const Sample& sample);
  void update_frames(const Sample& sample);
  void update_twist(const CycleRecord& record);
  void update_limits(const CycleRecord& record);

  int gantry_joints_, manipulator_joints_;
  std::vector<Place> twin_places_;
  JointState device_, twin_, limits_;
  WrenchStamped user_wrench_;
  TwistStamped handle_twist_;
  TransformMessage transforms_;
  LinkTree links_;
  std::vector<Pose> link_poses_;
  Eigen::Matrix3d last_R_B_H_ = Eigen::Matrix3d::Identity();
  double last_time_s_ = 0.0;
  bool has_last_ = false;
};

}  // namespace hg::messages
