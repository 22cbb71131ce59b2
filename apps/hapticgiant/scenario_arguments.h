/// Options shared by `run` and `simulate`: device, person and twin of a scenario.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace hg::apps {

struct ScenarioArguments {
  std::string scenario = "door";
  std::string device;  ///< device.yaml instead of the scenario's; empty = its own
  std::string twin;    ///< twin.yaml instead of the scenario's; empty = its own
  std::string user;    ///< user: see find_script(), or "mouse" or "none"; empty = the scenario's
  std::optional<double> rate_Hz;  ///< rate; unset = the device's
  std::string plant;              ///< plant, "elastic" or "ideal"; empty = as the device is
  std::string simulation;         ///< simulation, see find_simulation(); empty = that of the device
  std::string sensors;  ///< sensors, "real" or "ideal"; empty = as the device's simulation
  std::string hand;     ///< hand, "relaxed", "normal" or "stiff"; empty = the script's
  std::optional<std::uint64_t> seed;  ///< seed of the simulation
  std::optional<double> step_s;       ///< largest step of the plant
};

}  // namespace hg::apps
