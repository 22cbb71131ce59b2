/// The friction of each joint of a device from a recording of its motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/identify/friction.h"
#include "hg/recording/recording_reader.h"

namespace hg::identify {

struct JointFriction {
  std::string name;
  FrictionEstimate found;
  ActuatorModel nominal;  ///< as the device file says
};

struct RecordedFriction {
  std::vector<recording::Loss> losses;  ///< damaged parts of the recording
  double used_s = 0.0;                  ///< time with the drives on, s
  std::vector<JointFriction> joints;    ///< joints of the manipulator
};

/// Identifies the friction in a recording, compared with `device`; empty = the device that the
/// recording was made with. Throws SetupError, also where no sample shows friction.
RecordedFriction identify_recorded_friction(const std::string& file,
                                            std::optional<config::DeviceConfig> device);

}  // namespace hg::identify
