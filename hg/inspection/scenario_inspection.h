/// Whether a device can show a twin: start, workspace, and accelerations that it can brake.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/twin.h"
#include "hg/inspection/findings.h"

namespace hg::inspection {

/// What one joint of the twin, alone, asks of the device with its largest acceleration and speed.
struct Demand {
  std::string joint;
  double acceleration = 0.0;  ///< of the handle along an axis of B, per Cartesian rating; 1 = all
  double speed = 0.0;         ///< the same for the speed
  double joint_acceleration = 0.0;  ///< of the device's joints, 95 % of the postures below; 1 = all
  std::string device_joint;         ///< that is asked most
};

/// A twin held by a device, over postures of the twin.
struct Match {
  int postures = 0;             ///< looked at
  int reached = 0;              ///< of these: the device has a posture within its limits
  std::string worst;            ///< why the first other one is not reached; empty if all are
  ConfigurationA q_worst;       ///< of the twin, there
  std::vector<Demand> demands;  ///< per scalar joint of the twin, over the reached postures
};

Match match(const config::Device& device, const config::Twin& twin);

/// All findings about the pair; they stand at keys of the twin.
Findings inspect(const config::Device& device, const config::Twin& twin);

}  // namespace hg::inspection
