/// Commands of a page.
#pragma once

#include <cstdint>
#include <string>

namespace hg::viewer_server {

enum class CommandName : std::uint8_t {
  kPause,     ///< stops simulated time
  kResume,    ///< continues with the speed before
  kStep,      ///< `value` cycles, 1..1000, while paused; of a recording: frames
  kSpeed,     ///< simulated seconds per second
  kRestart,   ///< restarts the same run from its beginning
  kStop,      ///< controlled stop
  kScenario,  ///< starts another run: `name` of Choices
  kTwin,
  kDevice,
  kSurfaces,
  kLaw,
  kPerson,
  kSet,            ///< gives the setting `name` the value `value`
  kSeek,           ///< jumps to second `value` of a recording
  kPanel,          ///< switch or key `name` of the operator's panel: `value` 1 on, 0 off
  kMode,           ///< requests the mode `name`: arm, run, run_alone, hold or reset
  kEmergencyStop,  ///< presses the emergency stop
  kMark,           ///< records an event
  kReleaseStop,    ///< releases the stop pressed by page `value`; 0: by the script
  kAskForHand,     ///< asks the page that drags to let go
  kClutch,         ///< clutch to a remote machine: `value` 1 opens, 0 closes it
};

/// Largest number of a page: whole numbers of JavaScript, 2^53.
inline constexpr double kLargestPage = 9007199254740992;

/// Decoded command with finite numbers; `page` and `id` are returned with the answer.
struct Command {
  std::uint64_t page = 0;
  double id = 0.0;
  CommandName name = CommandName::kPause;
  std::string argument;
  double value = 0.0;
  std::uint32_t stops = 0;  ///< stop count of the operator's desk at its arrival
  bool is_done = false;     ///< already executed and answered by the server: for information only
};

}  // namespace hg::viewer_server
