/// The main job: a person at a device, and the twin they feel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/hapticgiant/scenario_arguments.h"

namespace hg::apps {

struct RunArguments {
  std::string program = "hapticgiant";  ///< as it was called, for commands that it prints
  ScenarioArguments world;
  std::string device_address;  ///< HOST:PORT of a remote device; empty = simulated here
  std::string key_file;        ///< of the key that it must have, too; empty = none
  /// Unset: until the script has played; on a terminal with a page until Ctrl-C.
  std::optional<double> duration_s;
  bool is_fast = false;   ///< as fast as it can, without page
  std::string law;        ///< "gauss" or "paper"; empty = the device's
  std::string bounds;     ///< "recoverable" or "paper"; empty = the device's
  std::string gantry;     ///< "law" or "rule"; empty = the device's
  std::string braking;    ///< "alone" or "together"; empty = the device's
  std::string passivity;  ///< "off", "observe" or "act"; empty = the device's
  std::string summary;    ///< JSON file; empty = none
  bool has_viewer = true;
  std::string address = "127.0.0.1";          ///< at which the page is served
  std::uint16_t port = 0;                     ///< of the page; 0 = any free one
  bool opens_browser = true;                  ///< where there is a display
  std::string recordings = "recordings";      ///< also keeps what is known of a machine
  bool without_start_test = false;            ///< a machine whose brakes nobody has tested
  std::vector<std::string> confirmed_joints;  ///< of a machine that do stand elsewhere than before
  bool has_recording = true;              ///< and problems of the solver that failed or were slow
  std::string flight_recorder = "fault";  ///< when the last seconds are written: fault, always, off
  int slow_solve = 100;                   ///< active sets from which on a problem is slow
  int priority = 80;  ///< of the control thread, SCHED_FIFO; 0 = an ordinary thread
  int cpu = -1;       ///< the only processor of the control thread; -1 = any
};

/// Exit code: 0 fine, 1 an expected event is missing or a limit was exceeded, 3 a fault stopped the
/// device, 4 (kNotWritten) recording or summary could not be written. Throws SetupError for bad
/// input.
int run(const RunArguments& arguments);

}  // namespace hg::apps
