/// A simulated person: takes the handle and pulls it towards the desired pose of the hand, given by
/// a script, a walk or a mouse. Source: [HANDBOOK] 5.
///
/// SI units; wrenches act on the handle, at H, resolved in B. Copyable, no allocation, noexcept
/// after set-up; the same calls give the same bits.
#pragma once

#include <array>
#include <cstdint>

#include "hg/core/types.h"
#include "hg/model/chain_data.h"
#include "hg/signals/frames.h"
#include "hg/signals/truth.h"
#include "hg/simulator/person/hand.h"
#include "hg/simulator/person/intention.h"
#include "hg/simulator/person/script.h"
#include "hg/simulator/person/tremor.h"
#include "hg/simulator/person/walker.h"

namespace hg::person {

enum class PersonKind {
  kNone,    ///< no person pulls; the dead-man switch is tied down
  kScript,  ///< plays a script
  kMouse,   ///< follows HandTarget only
};

struct PersonConfig {
  PersonKind kind = PersonKind::kScript;
  HandImpedance hand;
  Script script;
  std::uint64_t seed = 1;  ///< seed of the tremor
};

class Person {
 public:
  /// `twin` and its frame `end_effector` give the pose of kTwinJoints and kCylindrical channels.
  Person(const PersonConfig& config, const model::ChainModel& twin, int end_effector,
         const Pose& T_B_twin);

  /// Wrench on the handle at time `t`, in s since the start of the run; the arm advances from call
  /// to call. An active hand target overrides the script. A goal that jumps is approached as
  /// intention.h says. Zero before Script::grasp_s.
  Vector6 wrench(double t, const HandleMotion& handle, const HandTarget& target) noexcept;

  /// Whether the hand closes the dead-man switch at time `t`: permanently from the grasp on.
  bool is_holding(double t) const noexcept { return t >= config_.script.grasp_s; }

  /// Duration of the script including the time before the grasp, s; 0 without a script.
  double duration_s() const noexcept;

  /// The walking body.
  const Walker& walker() const noexcept { return walker_; }
  /// The same for the truth at time `t`, that of the last wrench().
  WalkerReport walker_report(double t) const noexcept;

  /// Score of a walk along checkpoints.
  const Score& score() const noexcept { return score_; }

 private:
  void grasp(double t, const HandleMotion& handle) noexcept;
  bool is_pulling(const HandTarget& target) const noexcept;
  Goal script_goal(double t, double dt, const Pose& T_B_H) noexcept;
  Pose channel_pose() noexcept;
  void approach(double dt, Goal& goal) noexcept;
  void keep_score(double dt, const HandleMotion& handle) noexcept;

  PersonConfig config_;
  model::ChainData twin_;
  int end_effector_;
  Pose T_B_twin_;
  Arm arm_;
  Tremor tremor_;
  Walker walker_;

  bool has_grasped_ = false;
  bool follows_target_ = false;  ///< whether an active hand target overrides the script
  double time_s_ = 0.0;          ///< time of the last call
  Pose target_;                  ///< goal of the last call, as it was given
  Approach position_{{}}, orientation_{{.jump = 1000.0, .speed = 3.0, .acceleration = 15.0}};
  std::array<double, kChannels> channels_{};  ///< present values of the script's channels

  Score score_;
  /// Position of the start or the last checkpoint
  Eigen::Vector2d last_point_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d last_p_H_ = Eigen::Vector2d::Zero();
  double way_ = 0.0, impulse_ = 0.0, walked_s_ = 0.0, since_point_s_ = 0.0;  ///< accumulated so far
};

}  // namespace hg::person
