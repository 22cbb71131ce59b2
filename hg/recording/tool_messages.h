/// Part of a sample that other tools understand, as standard ROS messages.
///
/// Frames: "base" = B, "handle" = H at the reference, "elbow" (orientation of B). ROS gives a
/// wrench in the frame where it acts, so the user's wrench is turned from B into H.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hg/recording/recorder.h"
#include "hg/recording/ros_messages.h"
#include "hg/signals/state.h"

namespace hg::recording {

class ToolMessages {
 public:
  explicit ToolMessages(const RecordingInfo& info);

  /// Fills all messages. Values missing in the sample are NaN.
  void update(const Sample& sample, std::uint64_t time_ns);

  const JointState& device() const noexcept { return device_; }  ///< gantry, then manipulator
  const JointState& twin() const noexcept { return twin_; }      ///< joints with one coordinate
  const WrenchStamped& user_wrench() const noexcept { return user_wrench_; }
  const TransformMessage& transforms() const noexcept { return transforms_; }

 private:
  /// Index of a twin's joint in q_a, and in dq_a and tau_a.
  struct Place {
    int coordinate, velocity;
  };

  void update_joints(const Sample& sample);
  void update_frames(const CycleRecord& record);

  int gantry_joints_, manipulator_joints_;
  std::vector<Place> twin_places_;
  JointState device_, twin_;
  WrenchStamped user_wrench_;
  TransformMessage transforms_;
};

}  // namespace hg::recording
