/// Tests brakes and stop inputs of a device, with an operator present.
#pragma once

#include <string>

#include "hg/scenario/options.h"

namespace CLI {
class App;
}

namespace hg::apps {

struct StartTestArguments {
  scenario::ScenarioOptions world{.scenario = "free_space"};
  /// HOST:PORT of a remote device, or ethercat://INTERFACE; empty = simulated here
  std::string device_address;
  std::string machine;   ///< machine.yaml of a bus; empty = the one beside the device file
  std::string key_file;  ///< file of the key shared with the device; empty = none
  bool is_fast = false;  ///< lock-step with a remote device
  int priority = 80;     ///< SCHED_FIFO priority, with a remote device in real time; 0 = ordinary
  std::string recordings = "recordings";  ///< folder for the result
};

/// Exit code: 0 passed, 1 something failed or the test was broken off, 3 the device has gone.
/// Throws SetupError for bad input.
int start_test(const StartTestArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_start_test(CLI::App& app, int& exit_code);

}  // namespace hg::apps
