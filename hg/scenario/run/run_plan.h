/// A run of a scenario as set-up data, in five parts; each function of a run takes those it needs.
///
/// Messages name a value by its option of `hapticgiant run`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/scenario/options.h"

namespace hg::scenario {

/// The device that a run drives, where it is not simulated here.
struct MachineAddress {
  std::string address;       ///< --device-address, see transports.h; empty = simulated here
  std::string machine_file;  ///< machine.yaml of a bus; empty = the one beside the device file
  std::string key_file;      ///< file of the key shared with the device; empty = none
  /// Items of the doctor that may be bad on a computer that drives a machine
  std::vector<std::string> despite;
  /// Joints of a machine confirmed to have moved since the last run
  std::vector<std::string> confirmed_joints;
  bool without_start_test = false;  ///< allows a machine with untested brakes
  bool moves_to_start = false;      ///< the device first moves to where the twin starts
};

struct RunTiming {
  /// Duration of the run, s; unset = until the script has played
  std::optional<double> duration_s;
  /// A run with a page and without a duration continues after the script, until its stop flag.
  bool continues = false;
  bool is_fast = false;  ///< as fast as possible, without page
  int priority = 80;     ///< SCHED_FIFO priority of the control thread; 0 = an ordinary thread
  int cpu = -1;          ///< CPU of the control thread; -1 = any
};

/// What a run leaves behind or sends.
struct RunRecords {
  /// Folder of recordings and of the stored data of a machine
  std::string folder = "recordings";
  bool has_recording = true;  ///< writes the recording and the solver's failed or slow problems
  /// The recording is recording.mcap, with is_fast the same bytes for the same run; RecordingInfo
  bool is_reproducible = false;
  /// Condition for writing the last seconds: fault, always, off
  std::string flight_recorder = "fault";
  int slow_solve = 100;          ///< number of active sets from which a problem is slow
  bool has_lab_streams = false;  ///< sends samples and events to the Lab Streaming Layer
};

struct RunPageOptions {
  bool is_served = true;
  std::string address = "127.0.0.1";  ///< address at which the page is served
  std::uint16_t port = 0;             ///< port of the page; 0 = any free one
  std::string token_file;             ///< keeps the secret of the link; empty: a new one each time
  /// Web origins whose pages may show the page inside themselves; the run is a trial of theirs
  std::vector<std::string> embedders;
  bool opens_browser = true;  ///< for who shows the link: whether to open it

  /// Whether the run is a trial of a study: its page changes nothing and does not restart it.
  bool is_trial() const { return !embedders.empty(); }
};

struct RunPlan {
  ScenarioOptions world;
  MachineAddress machine;
  RunTiming timing;
  RunRecords records;
  RunPageOptions page;
};

}  // namespace hg::scenario
