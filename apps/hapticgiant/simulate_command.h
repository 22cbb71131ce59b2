/// `hapticgiant simulate [SCENARIO] --listen HOST:PORT`: the simulated device and person of a
/// scenario for a controller elsewhere.
#pragma once

#include <optional>
#include <string>

namespace hg::apps {

struct SimulateArguments {
  std::string scenario = "door";
  std::string listen;              ///< HOST:PORT
  std::string device, twin, user;  ///< as in RunArguments
  std::optional<double> rate_Hz;   ///< unset: the device's
  bool is_fast = false;            ///< lock-step instead of real time
  std::string capture;             ///< pcap file of all datagrams; empty = none
};

/// Serves one client after the other until Ctrl-C, each with a world that begins anew. Exit code 0.
/// Throws SetupError for bad input.
int simulate(const SimulateArguments& arguments);

}  // namespace hg::apps
