/// Whether a posture fits to what does not come from its encoders, and which joint would have to be
/// elsewhere.
#pragma once

#include <string>
#include <vector>

#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"

namespace hg::commission {

/// A direction that is known in B and was measured in the sensor frame S: gravity, a pull.
struct Direction {
  Eigen::Vector3d in_B, in_S;
  double within = 0.0;  ///< Largest angle between the two that counts as none, rad
};

/// Measured at rest, brakes closed.
struct AtRest {
  VectorPM q;                         ///< Positions, gantry first, rad or m
  std::vector<Direction> directions;  ///< At least one, for explain()
  VectorM tau;                        ///< Torque sensors, Nm; empty: there are none
};

/// Largest angle by which a direction is elsewhere than the posture has it, over what is allowed:
/// above 1 the posture does not fit.
double misfit(const AtRest& measured, const DeviceModel& device, model::ChainData& chain);

/// Joint whose torque sensor does not carry the weight of the links beyond it; -1: none, or there
/// are no sensors. `counted`: how many joints carry enough to show it.
int wrong_torque(const AtRest& measured, const DeviceModel& device, model::ChainData& chain,
                 int& counted);

/// What would make a posture fit: one joint elsewhere than its encoder says, or two that are
/// swapped, in words; empty: none of these.
std::string explain(const AtRest& measured, const DeviceModel& device, model::ChainData& chain);

/// Joints whose zero position shows nowhere: gravity, and the axes of all joints before them, are
/// parallel to their own axis. By name, separated by commas.
std::string unseen_zeros(const VectorPM& q, const DeviceModel& device, model::ChainData& chain);

}  // namespace hg::commission
