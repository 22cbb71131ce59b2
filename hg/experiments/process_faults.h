/// Reaction of a moving device to faults of the controller's
/// process: terminal, disk, memory, processors, or the process itself.
///
/// The device is served here, in real time, over the network protocol; the controller is a separate
/// `hapticgiant run`. The device's side thus observes every failure of the controller, and
/// evaluates the true motion of its axes.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace hg::experiments {

enum class ProcessFault : std::uint8_t {
  kNone = 0,             ///< no fault, only the stop
  kTerminalStalled = 1,  ///< the output is not read
  kTerminalClosed = 2,   ///< the reader of the output has closed
  kDiskFull = 3,         ///< no file may grow
  kFolderGone = 4,       ///< the folder of its recording is removed
  kNoDescriptors = 5,    ///< no more descriptors can be opened
  kNoMemory = 6,         ///< no more memory is available
  kBusy = 7,             ///< other processes occupy all processors
  kFrozen = 8,           ///< the process is suspended, and continues a second later
  kSuspended = 9,        ///< the process is suspended permanently
  kKilled = 10,
};

/// Result of one process fault.
struct ProcessCase {
  ProcessFault fault = ProcessFault::kNone;
  std::string scenario;
  bool has_run = false;  ///< false = the values below were not measured
  double rest_s = 0.0;   ///< time from the stop until all axes stood still permanently; NaN = never
  /// Largest travel of an axis from the stop on, share of its stopping distance
  double travel_share = 0.0;
  double energy = 0.0;  ///< energy given to the person from the stop on, J
  int exit_code = -1;   ///< exit code of the controller; -1 = ended by a signal
  /// The controller (for kSuspended, the device's session with it) ended in time
  bool has_ended = false;
  std::uint64_t recorded = 0;  ///< number of readable samples of its recording
  std::uint64_t periods = 0;   ///< number of periods of the device with this controller
  bool is_good = false;        ///< all requirements are met
};

/// Plays all faults in the scenarios (names or files) in turn, with `program` (hapticgiant) as the
/// controller, `repetitions` times at random
/// moments. The stop is a SIGTERM 0.3 s after the fault; for a controller that is suspended or
/// killed the fault itself. Throws SetupError.
std::vector<ProcessCase> play_process_faults(const std::string& program,
                                             const std::vector<std::string>& scenarios,
                                             int repetitions, std::uint64_t seed);

/// All cases; python/hapticgiant/report/process_faults.py makes a table of it.
nlohmann::ordered_json to_json(const std::vector<ProcessCase>& cases);

}  // namespace hg::experiments
