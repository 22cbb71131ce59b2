/// Typical joints of arms, for simulating one whose maker publishes no more than ratings.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hg/signals/actuator_model.h"

namespace hg::config {

struct ActuatorType {
  std::string name;
  std::string source;  ///< what the values are typical of
  double gear_ratio = 1.0;
  ActuatorModel model;
};

/// Reads a library such as models/actuators.yaml. Throws SetupError with all faults of the file,
/// one per line.
std::vector<ActuatorType> load_actuator_library(const std::filesystem::path& file);

/// The type of `library` (not empty) with the peak torque nearest to `torque_max` (Nm), scaled to
/// it; its full torque is available up to `dq_max` (rad/s).
ActuatorType actuator_for(const std::vector<ActuatorType>& library, double torque_max,
                          double dq_max);

}  // namespace hg::config
