/// Checks over the workspace whether the joints can provide the accelerations of the Cartesian
/// limits.
///
/// A Cartesian row brakes with A_c; that takes A_c <= 1/2 sum |J_xi| A_i of the manipulator joints
/// i along axis x (docs/start/check.md). The half is left to the other rows. A speed limit needs no
/// such rule: where the joints are slower it does not act.
#pragma once

#include <vector>

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/workspace/survey.h"

namespace hg::check {

/// One axis of one Cartesian limit.
struct CartesianRule {
  int limit = 0, axis = 0;
  int postures = 0;  ///< number of surveyed postures within the braking distance of a face
  double share_too_weak = 0.0;    ///< share of these that cannot brake with A_c
  double share_weak = 0.0;        ///< 0.05, or 0.01 where no more than 0.05 are too weak
  double low_acceleration = 0.0;  ///< less than this share of these give less for braking
};

std::vector<CartesianRule> cartesian_rules(const config::DeviceConfig& device,
                                           const workspace::Survey& survey);

void inspect_cartesian_rule(const config::DeviceConfig& device, const workspace::Survey& survey,
                            Collector& out);

}  // namespace hg::check
