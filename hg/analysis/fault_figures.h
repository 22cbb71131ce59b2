/// Details of a fault or warning beyond its rule: part of the machine, value, allowed value.
#pragma once

#include <string>
#include <vector>

#include "hg/signals/fault.h"
#include "hg/signals/frames.h"
#include "hg/signals/limit.h"

namespace hg::analysis {

struct Names {
  std::vector<std::string> joints;  ///< joint names of the manipulator
  std::vector<std::string> gantry;
  std::vector<std::string> pairs;  ///< names of the pairs that may collide
  LimitCatalogue limits;
};

/// Name with this index, or "OTHERWISE INDEX" where the list has none.
std::string name_in(const std::vector<std::string>& list, int index, const char* otherwise);

/// Part of the machine: "m4", "torque sensor m2"; empty = no part. `sensors` shows which values the
/// device has.
std::string part_of(const Fault& fault, const Names& names, const SensorFrame& sensors);

/// Part, value and limit: "m4: 0.083, limit 0.08"; empty = nothing beyond the rule.
std::string figures_of(const Fault& fault, const Names& names, const SensorFrame& sensors);

}  // namespace hg::analysis
