/// What a page may ask for, and how it is answered.
#pragma once

#include <cstdint>
#include <string>

namespace hg::viewer_server {

enum class CommandName : std::uint8_t {
  kPause,     ///< simulated time stands still
  kResume,    ///< and goes on, with the speed before
  kStep,      ///< `value` cycles, 1..1000, while paused; of a recording: frames
  kSpeed,     ///< simulated seconds per second
  kRestart,   ///< the same run from its start
  kStop,      ///< controlled stop
  kScenario,  ///< another run: `name` of Choices
  kTwin,
  kLaw,
  kPerson,
  kSet,            ///< the setting `name` gets `value`
  kSeek,           ///< second `value` of a recording
  kPanel,          ///< switch or key `name` of the operator's panel: `value` 1 on, 0 off
  kMode,           ///< asks for the mode `name`: arm, run, run_alone, hold or reset
  kEmergencyStop,  ///< presses it
  kReleaseStop,    ///< takes back what page `value` has pressed; 0: the script
};

/// Whole numbers of JavaScript: 2^53.
inline constexpr double kLargestPage = 9007199254740992;

/// One that has been read and whose numbers are finite; `page` and `id` go back with the answer.
struct Command {
  std::uint64_t page = 0;
  double id = 0.0;
  CommandName name = CommandName::kPause;
  std::string argument;
  double value = 0.0;
  std::uint32_t stops = 0;  ///< that the operator's desk had counted when it came
  bool is_done = false;     ///< followed and answered by the server already: to be told only
};

}  // namespace hg::viewer_server
