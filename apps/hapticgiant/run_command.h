/// The main job: a person at a device, and the twin they feel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace hg::apps {

struct RunArguments {
  std::string program = "hapticgiant";  ///< as it was called, for commands that it prints
  std::string scenario = "door";
  std::string device;          ///< device.yaml instead of the scenario's; empty = the scenario's
  std::string twin;            ///< twin.yaml likewise
  std::string device_address;  ///< HOST:PORT of a remote device; empty = simulated here
  std::string user;            ///< script file, "mouse" or "none"; empty = the scenario's
  /// Unset: until the script has played; on a terminal with a page until Ctrl-C.
  std::optional<double> duration_s;
  bool is_fast = false;               ///< as fast as it can, without page
  std::optional<double> rate_Hz;      ///< unset: the device's
  std::string plant;                  ///< "elastic" or "ideal"; empty = as the device is
  std::string sensors;                ///< "real" or "ideal"; empty = as the device's simulation
  std::string hand;                   ///< "relaxed", "normal" or "stiff"; empty = the script's
  std::optional<std::uint64_t> seed;  ///< of the simulation
  std::optional<double> step_s;       ///< largest step of the plant
  std::string law;                    ///< "gauss" or "paper"; empty = the device's
  std::string bounds;                 ///< "recoverable" or "paper"; empty = the device's
  std::string summary;                ///< JSON file; empty = none
  bool has_viewer = true;
  std::string address = "127.0.0.1";  ///< at which the page is served
  std::uint16_t port = 0;             ///< of the page; 0 = any free one
  bool opens_browser = true;          ///< where there is a display
  std::string recordings = "recordings";
  bool has_recording = true;  ///< and problems of the solver that failed or were slow
  int slow_solve = 100;       ///< active sets from which on a problem is slow
};

/// Exit code: 0 fine, 1 an expected event is missing or a limit was exceeded, 3 a fault stopped the
/// device. Throws SetupError for bad input.
int run(const RunArguments& arguments);

}  // namespace hg::apps
