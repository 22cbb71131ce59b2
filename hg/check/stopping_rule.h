/// Checks whether the stopping time and distances of device.yaml allow a stop from full speed.
#pragma once

#include <string>
#include <vector>

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/controller/safety/stopping.h"

namespace hg::check {

/// One joint or axis of the gantry.
struct Stopping {
  std::string name;
  bool is_angle = true;       ///< unit is rad, otherwise m
  safety::StoppingNeed need;  ///< need for a stop from full speed with the ratings
  double distance = 0.0;      ///< stated distance; the brakes close before it is used up
  std::string key;            ///< key that states the distance
};

/// Stopping needs of all axes, gantry first.
std::vector<Stopping> stopping_of(const config::DeviceConfig& device);

/// Adds a fault for every distance, and a warning for a time, that an ordinary stop would exceed,
/// and a warning for a distance far above any stop.
void inspect_stopping(const config::DeviceConfig& device, Collector& out);

}  // namespace hg::check
