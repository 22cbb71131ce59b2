/// A simulated person: pulls the handle towards where the hand wants it, through the impedance of
/// an arm, and pushes as the script says. Source: [HANDBOOK] 5.1, 5.3.
///
/// SI units; wrenches act on the handle, at H, resolved in B. No allocation, noexcept after set-up.
#pragma once

#include "hg/core/types.h"
#include "hg/model/chain.h"
#include "hg/signals/frames.h"
#include "hg/user/script.h"

namespace hg::user {

/// Hand impedance. Angular values hold about the axes of H.
struct HandImpedance {
  Eigen::Vector3d stiffness{200, 200, 200};        ///< N/m in B
  Eigen::Vector3d damping{20, 20, 20};             ///< Ns/m
  Eigen::Vector3d angular_stiffness{2, 2, 2};      ///< Nm/rad
  Eigen::Vector3d angular_damping{0.1, 0.1, 0.1};  ///< Nms/rad
  double force_max = 60;                           ///< a person pulls no harder, N
  double torque_max = 8;                           ///< Nm
  double press_force = 14;  ///< with HandTarget::press = 1, downwards at the handle, N
};

/// Throws SetupError naming the field that is out of range.
void check(const HandImpedance& hand);

enum class PersonKind {
  kNone,    ///< nobody holds the handle
  kScript,  ///< plays a script
  kMouse,   ///< follows HandTarget only
};

struct Config {
  PersonKind kind = PersonKind::kScript;
  HandImpedance hand;
  Script script;
};

/// Where and how fast the handle is.
struct HandleMotion {
  Pose T_B_H;
  Vector6 twist = Vector6::Zero();
};

class Person {
 public:
  /// `twin` and its frame `end_effector` give the pose of kTwinJoints and kCylindrical channels.
  Person(const Config& config, const model::Chain& twin, int end_effector, const Pose& T_B_twin);

  /// Wrench on the handle at time `t`. An active hand target overrules the script.
  Vector6 wrench(double t, const HandleMotion& handle, const HandTarget& target) noexcept;

  /// Seconds until the script has played; 0 without a script.
  double duration_s() const noexcept;

 private:
  struct Goal {
    Pose pose;
    Vector6 twist = Vector6::Zero();
    bool has_orientation = true;
  };
  Goal script_goal(double t, const std::array<double, kChannels>& channels) noexcept;
  Pose channel_pose(const std::array<double, kChannels>& channels) noexcept;

  Config config_;
  model::Chain twin_;
  int end_effector_;
  Pose T_B_twin_;
};

}  // namespace hg::user
