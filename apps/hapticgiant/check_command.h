/// `hapticgiant check FILE...`: faults of devices, twins, scenarios, tools and scripts, with
/// suggested changes; a datasheet for every device.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

class Command;

struct CheckArguments {
  std::vector<std::string> files;
  std::string json;  ///< result as JSON; empty = none
  std::string map;   ///< capability map of the first device as SVG; empty = none
};

/// Prints to stdout. Returns the exit code: 0, warnings or not, or 2 when there is any fault.
int run_check(const CheckArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_check(Command app, int& exit_code);

}  // namespace hg::apps
