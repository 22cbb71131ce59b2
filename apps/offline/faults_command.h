/// `hapticgiant faults`: injected faults in many simulated runs.
#pragma once

#include <string>
#include <vector>

#include "apps/offline/campaign.h"
#include "hg/experiments/fault_campaign.h"

namespace hg::apps {

class Command;

struct FaultsArguments {
  /// Scenarios; empty: with a device or twin the one of experiments::moved_scenario(), otherwise
  /// the shipped ones
  std::vector<std::string> scenarios;
  std::string device, twin;  ///< files that replace those of the scenarios; empty = their own
  experiments::CampaignConfig campaign;
  CampaignOptions played;
  std::string json;      ///< file for all cases; empty = none
  std::string markdown;  ///< file for the table as a page; empty = none
  std::string docs;      ///< folder of documentation to refresh; empty = none
};

/// Prints a table. Returns the exit code: 1 when a fault was unnoticed or went beyond the bounds;
/// bad input is thrown as SetupError.
int faults(FaultsArguments arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_faults(Command app, int& exit_code);

}  // namespace hg::apps
