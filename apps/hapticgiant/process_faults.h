/// `hapticgiant faults --processes`: what becomes of a moving device when the process that controls
/// it gets into trouble: its terminal, its disk, its memory, its processors, itself.
///
/// The device is served from here, in real time, over the network protocol; the controller is a
/// `hapticgiant run` of its own. So whatever becomes of the controller, the device's side has seen
/// it, and judges by how its axes really moved.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace hg::apps {

enum class ProcessFault : std::uint8_t {
  kNone = 0,             ///< only the stop
  kTerminalStalled = 1,  ///< nobody reads what it prints
  kTerminalClosed = 2,   ///< what it prints has no reader any more
  kDiskFull = 3,         ///< no file may grow
  kFolderGone = 4,       ///< the folder of its recording is removed
  kNoDescriptors = 5,    ///< it may open nothing more
  kNoMemory = 6,         ///< it gets no more memory
  kBusy = 7,             ///< others take all processors
  kFrozen = 8,           ///< it is suspended, and goes on a second later
  kSuspended = 9,        ///< it is suspended for good
  kKilled = 10,
};

/// What became of one of them.
struct ProcessCase {
  ProcessFault fault = ProcessFault::kNone;
  std::string scenario;
  bool has_run = false;       ///< otherwise nothing below was measured
  double rest_s = 0.0;        ///< from the stop until all axes stood still for good; NaN: never
  double travel_share = 0.0;  ///< largest way of an axis from the stop on, of its stopping distance
  double energy = 0.0;        ///< given to the person from the stop on, J
  int exit_code = -1;         ///< of the controller; -1: a signal ended it
  bool has_ended = false;     ///< by itself
  std::uint64_t recorded = 0;  ///< samples of its recording that can be read
  std::uint64_t periods = 0;   ///< that the device lived with it
  bool is_good = false;        ///< it did what it must
};

/// Plays all faults in the scenarios (names or files) in turn, `repetitions` times at random
/// moments. The stop is a SIGTERM 0.3 s after the fault; for a controller that is suspended or
/// killed the fault itself. Throws SetupError.
std::vector<ProcessCase> play_process_faults(const std::vector<std::string>& scenarios,
                                             int repetitions, std::uint64_t seed);

/// A row per case, and the verdict.
std::string to_text(const std::vector<ProcessCase>& cases);
nlohmann::ordered_json to_json(const std::vector<ProcessCase>& cases);

}  // namespace hg::apps
