/// Plays a scenario on the simulated device and records what an instrument at the handle would
/// measure.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/core/types.h"
#include "hg/simulator/person/script.h"

namespace hg::haptify {

/// One sample after the hand has taken the handle; true values, in B.
struct Instant {
  double time_s = 0.0;  ///< time since the grasp
  Pose T_B_H;           ///< pose of the handle
  Vector6 twist = Vector6::Zero(), acceleration = Vector6::Zero();
  Vector6 w_H = Vector6::Zero();                      ///< wrench of the person
  Eigen::Vector3d p_B_E = Eigen::Vector3d::Zero();    ///< position of the twin, as rendered
  Eigen::Vector3d p_ref = Eigen::Vector3d::Zero();    ///< position of the handle at the reference
  Eigen::Vector3d surface = Eigen::Vector3d::Zero();  ///< force of virtual surfaces on the twin, N
  /// Power of that force on the twin, without the share taken by limits, W
  double contact_power = 0.0;
  VectorP q_p, dq_p;          ///< position and velocity of the gantry
  VectorM q_m, dq_m;          ///< position and velocity of the manipulator's links
  bool is_limited = false;    ///< a limit of the device is felt
  double joint_error = 0.0;   ///< largest difference of reference and true link, rad or m
  double torque_share = 0.0;  ///< largest motor torque over its peak
};

struct Played {
  std::vector<Instant> instants;
  std::string failure;  ///< fault or exceeded limit in words; empty = none
};

/// The scenario with another script for the person, who holds the handle; its events are cleared.
config::Scenario with_script(config::Scenario scenario, const person::Script& script);

/// Changes the drive commands of the gantry at a time, as an imperfection of the drives.
using Disturbance = std::function<void(double time_s, VectorP& dq_p)>;

/// Plays the scenario once from start to end, as fast as possible. `disturbance` acts while the
/// device runs.
Played play(const config::Scenario& scenario, const Disturbance& disturbance = {});

}  // namespace hg::haptify
