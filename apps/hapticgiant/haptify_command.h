/// `hapticgiant haptify`: the benchmark of Table III of the paper on the simulated device.
#pragma once

#include <cstdint>
#include <string>

#include "hg/haptify/figures.h"

namespace hg::apps {

struct HaptifyArguments {
  std::string out = "haptify";  ///< folder
  std::string docs;             ///< folder of documentation to refresh; empty = none
  std::string simulation;       ///< see find_simulation(); empty = as the device says
  std::string twin;             ///< twin.yaml of a free body instead of the shipped one
  bool only_goals = false;      ///< over seeds, heights and hands
  haptify::Options options;
};

/// Exit code: 0 all measured, 1 a measurement failed: fault, limit exceeded. A goal that is missed
/// is no failure: the report says why. Throws SetupError for bad input.
int run_haptify(const HaptifyArguments& arguments);

}  // namespace hg::apps
