/// `hapticgiant haptify`: the benchmark of Table III of the paper on the simulated device.
#pragma once

#include <cstdint>
#include <string>

#include "apps/offline/campaign.h"
#include "hg/experiments/haptify/benchmark.h"

namespace hg::apps {

class Command;

struct HaptifyArguments {
  std::string out = "haptify";  ///< output folder
  std::string docs;             ///< folder of documentation to refresh; empty = none
  std::string device;           ///< device.yaml; empty = the reference device's
  std::string simulation;       ///< simulation, see find_simulation(); empty = that of the device
  std::string twin;             ///< twin.yaml of a free body instead of the shipped one
  bool only_goals = false;      ///< measures only the design goals, over seeds, heights and hands
  haptify::HaptifyOptions options;
  CampaignOptions played;
};

/// Exit code: 0 all measured, 1 a measurement failed: fault, limit exceeded. A missed goal is no
/// failure: the report explains it. Throws SetupError for bad input.
int run_haptify(const HaptifyArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_haptify(Command app, int& exit_code);

}  // namespace hg::apps
