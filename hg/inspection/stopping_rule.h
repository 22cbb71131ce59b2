/// Whether the stopping time and distances of device.yaml leave room for a stop from full speed.
#pragma once

#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/inspection/findings.h"
#include "hg/safety/stopping.h"

namespace hg::inspection {

/// One joint or axis of the gantry.
struct Stopping {
  std::string name;
  bool is_angle = true;       ///< rad, otherwise m
  safety::StoppingNeed need;  ///< from full speed with the ratings
  double distance = 0.0;      ///< stated: before it the brakes close
  std::string key;            ///< that states it
};

/// Gantry first.
std::vector<Stopping> stopping_of(const config::Device& device);

/// Adds a fault for every distance, and a warning for a time, that an ordinary stop would exceed,
/// and a warning for a distance that no stop comes near to.
void inspect_stopping(const config::Device& device, Collector& out);

}  // namespace hg::inspection
