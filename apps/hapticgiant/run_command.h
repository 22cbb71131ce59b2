/// `hapticgiant run`: a person at a device, and the twin felt at its handle.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/scenario/options.h"

namespace hg::apps {

class Command;

struct RunArguments {
  std::string program = "hapticgiant";  ///< program name as called, for printed commands
  scenario::ScenarioOptions world;
  /// HOST:PORT of a remote device, franka://HOST or ethercat://INTERFACE; empty = simulated here
  std::string device_address;
  std::string machine;          ///< machine.yaml of a bus; empty = the one beside the device file
  bool moves_to_start = false;  ///< the device first moves to where the twin starts
  std::string key_file;         ///< file of the key shared with the device; empty = none
  /// Duration of the run, s; unset = until the script has played; on a terminal with a page until
  /// Ctrl-C.
  std::optional<double> duration_s;
  bool is_fast = false;  ///< runs as fast as possible, without page
  std::string summary;   ///< JSON file; empty = none
  bool has_viewer = true;
  std::string address = "127.0.0.1";  ///< address at which the page is served
  std::uint16_t port = 0;             ///< port of the page; 0 = any free one
  /// Web origins whose pages may show the page inside themselves; the run is a trial of theirs
  std::vector<std::string> embedders;
  bool opens_browser = true;  ///< opens a browser if there is a display
  /// Folder of recordings and of the stored data of a machine
  std::string recordings = "recordings";
  bool without_start_test = false;  ///< allows a machine with untested brakes
  /// Items of the doctor that may be bad on a computer that drives a machine
  std::vector<std::string> despite;
  /// Joints of a machine confirmed to have moved since the last run
  std::vector<std::string> confirmed_joints;
  bool has_lab_streams = false;  ///< sends samples and events to the Lab Streaming Layer
  bool has_recording = true;     ///< writes the recording and the solver's failed or slow problems
  /// Condition for writing the last seconds: fault, always, off
  std::string flight_recorder = "fault";
  int slow_solve = 100;  ///< number of active sets from which a problem is slow
  int priority = 80;     ///< SCHED_FIFO priority of the control thread; 0 = an ordinary thread
  int cpu = -1;          ///< CPU of the control thread; -1 = any

  /// Whether the run is a trial of a study: its page changes nothing and does not restart it.
  bool is_trial() const { return !embedders.empty(); }
};

/// Exit code: 0 fine, 1 an expected event is missing or a limit was exceeded, 3 a fault stopped the
/// device, 4 (kNotWritten) recording or summary could not be written. Throws SetupError for bad
/// input.
int run(const RunArguments& arguments);

/// Adds the subcommand to the program, which was called as `program`; running it sets `exit_code`.
void add_run(Command app, const std::string& program, int& exit_code);

}  // namespace hg::apps
