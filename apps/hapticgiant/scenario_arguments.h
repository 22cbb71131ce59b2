/// What device, person and twin of a scenario are: the options that `run` and `simulate` share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace hg::apps {

struct ScenarioArguments {
  std::string scenario = "door";
  std::string device;  ///< device.yaml instead of the scenario's; empty = its own
  std::string twin;    ///< twin.yaml likewise
  std::string user;    ///< see find_script(), or "mouse" or "none"; empty = the scenario's
  std::optional<double> rate_Hz;      ///< unset: the device's
  std::string plant;                  ///< "elastic" or "ideal"; empty = as the device is
  std::string simulation;             ///< see find_simulation(); empty = as the device says
  std::string sensors;                ///< "real" or "ideal"; empty = as the device's simulation
  std::string hand;                   ///< "relaxed", "normal" or "stiff"; empty = the script's
  std::optional<std::uint64_t> seed;  ///< of the simulation
  std::optional<double> step_s;       ///< largest step of the plant
};

}  // namespace hg::apps
