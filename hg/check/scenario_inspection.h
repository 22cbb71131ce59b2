/// Checks whether a device can render a twin: start, workspace, and accelerations that it can
/// brake.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/simulation/simulation.h"
#include "hg/config/twin.h"

namespace hg::check {

/// Demand of one joint of the twin, alone, on the device at its largest acceleration and speed.
struct Demand {
  std::string joint;
  /// Acceleration of the handle along an axis of B over the Cartesian rating; 1 = all of it
  double acceleration = 0.0;
  double speed = 0.0;  ///< speed of the handle over the Cartesian rating; 1 = all of it
  /// 95th percentile over postures of the device joints' acceleration over their rating; 1 = all of
  /// it
  double joint_acceleration = 0.0;
  std::string device_joint;  ///< device joint with the largest demand
};

/// A twin held by a device, over postures of the twin.
struct Match {
  int postures = 0;        ///< number of examined postures
  int reached = 0;         ///< number of these for which the device has a posture within its limits
  std::string worst;       ///< reason why the first other one is not reached; empty if all are
  ConfigurationA q_worst;  ///< configuration of the twin in that posture
  std::vector<Demand> demands;  ///< demand per scalar joint of the twin, over the reached postures
};

Match match(const config::DeviceConfig& device, const config::Twin& twin);

/// All findings about the pair, in front of the surfaces of a scenario; they stand at keys of the
/// twin.
Findings inspect(const config::SimulatedDeviceConfig& device, const config::Twin& twin,
                 std::span<const surfaces::Surface> surfaces = {});

/// A note where the twin has collision spheres and the scenario has no surface that they meet.
Findings inspect_spheres(const config::Scenario& scenario);

}  // namespace hg::check
