/// What a fault or a warning says beyond its rule: which part of the machine, how much, what was
/// allowed.
#pragma once

#include <string>
#include <vector>

#include "hg/signals/fault.h"
#include "hg/signals/frames.h"
#include "hg/signals/limit.h"

namespace hg::explanation {

struct Names {
  std::vector<std::string> joints;  ///< of the manipulator
  std::vector<std::string> gantry;
  std::vector<std::string> pairs;  ///< that may collide
  LimitCatalogue limits;
};

/// The name, or "OTHERWISE INDEX" where the list has none.
std::string name_in(const std::vector<std::string>& list, int index, const char* otherwise);

/// "m4", "torque sensor m2"; empty = no part. `sensors` tells which values the device has.
std::string part_of(const Fault& fault, const Names& names, const SensorFrame& sensors);

/// "m4: 0.083, limit 0.08"; empty = the rule says it all.
std::string figures_of(const Fault& fault, const Names& names, const SensorFrame& sensors);

}  // namespace hg::explanation
