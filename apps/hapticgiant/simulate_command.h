/// `hapticgiant simulate [SCENARIO] --listen HOST:PORT`: the simulated device and person of a
/// scenario for a controller elsewhere.
#pragma once

#include <string>

#include "hg/scenario/options.h"

namespace hg::apps {

class Command;

struct SimulateArguments {
  scenario::ScenarioOptions world;
  std::string listen;      ///< address to listen on, HOST:PORT
  std::string key_file;    ///< file of the key that clients must have; empty = none
  bool is_fast = false;    ///< lock-step instead of real time
  bool is_remote = false;  ///< the remote machine of its teleoperation instead of the device
  bool stays = false;      ///< each client finds the device where the last one has left it
  std::string capture;     ///< pcap file of all datagrams; empty = none
};

/// Serves one client after the other until Ctrl-C, each with a reset world unless the
/// device stays where it is. Exit code 0, or 4
/// (kNotWritten) if the capture is incomplete. Throws SetupError for bad input.
int simulate(const SimulateArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_simulate(Command app, int& exit_code);

}  // namespace hg::apps
