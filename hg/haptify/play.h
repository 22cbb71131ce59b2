/// Plays a scenario on the simulated device and keeps what an instrument at the handle would see.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hg/config/scenario.h"
#include "hg/core/types.h"
#include "hg/user/script.h"

namespace hg::haptify {

/// One sample from when the hand takes the handle; true values, in B.
struct Instant {
  double time_s = 0.0;  ///< since the grasp
  Pose T_B_H;           ///< handle
  Vector6 twist = Vector6::Zero(), acceleration = Vector6::Zero();
  Vector6 w_H = Vector6::Zero();                      ///< wrench of the person
  Eigen::Vector3d p_B_E = Eigen::Vector3d::Zero();    ///< twin, as it is rendered
  Eigen::Vector3d p_ref = Eigen::Vector3d::Zero();    ///< handle at the reference
  Eigen::Vector3d surface = Eigen::Vector3d::Zero();  ///< force of virtual surfaces on the twin, N
  double contact_power = 0.0;  ///< on the twin, of that force without what limits take of it, W
  VectorP q_p, dq_p;           ///< gantry
  VectorM q_m, dq_m;           ///< links of the manipulator
  bool is_limited = false;     ///< a limit of the device is felt
};

struct Played {
  std::vector<Instant> instants;
  std::string failure;  ///< fault or exceeded limit in words; empty = none
};

/// What a script does to a free body besides holding it.
config::Scenario with_script(config::Scenario scenario, const user::Script& script);

/// Once from start to end, as fast as it can.
Played play(const config::Scenario& scenario);

}  // namespace hg::haptify
