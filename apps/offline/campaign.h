/// Commands that consist of many independent runs: played in this process, or by `hapticgiant
/// sweep`.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/runs.h"

namespace hg::apps {

class Command;

struct CampaignOptions {
  std::string part;    ///< "I/N": plays this share only; empty = all
  std::string folder;  ///< where a sweep is kept and continued; empty = no sweep
};

/// Adds --part and --sweep.
void add_campaign_options(Command command, CampaignOptions& options);

/// A set of runs, and how this program is called to play a share of it.
struct Campaign {
  std::vector<std::string> command;         ///< words before --part
  std::size_t parts = 1;                    ///< shares
  std::vector<config::Scenario> scenarios;  ///< a sweep is not continued with others
  /// Asks for the runs, see experiments::Runs.
  std::function<void(experiments::Runs&)> play;
};

/// With --part: plays that share and prints its results for `sweep`; returns true, and the command
/// is done. With --sweep: plays all parts as processes and calls play() with their results; throws
/// SetupError where a part has none. Otherwise plays all runs in this process, on all processors.
bool play_campaign(const Campaign& campaign, const CampaignOptions& options);

/// Throws SetupError, with what to install, where --sweep cannot be played.
void check_sweep_program(const CampaignOptions& options);

/// A value of an option for a process that is started elsewhere: the path of a file is made
/// absolute, other names stay.
std::string file_or_name(const std::string& value);

}  // namespace hg::apps
