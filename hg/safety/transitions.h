/// The operating states and what may follow what, as data: `advance` does what stands here, and the
/// table of docs/safety.md is made from it.
///
/// Source: [HANDBOOK] 6.5, docs/safety.md. Every transition to a state with power needs an
/// edge of a request.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hg/signals/state.h"

namespace hg::safety {

/// Mode with what the supervisor has to know besides. Numbers are hashed and never change.
enum class State : std::uint8_t {
  kOff = 0,
  kReady = 1,
  kArmed = 2,
  kByHand = 3,      ///< running while the user holds the handle
  kAutonomous = 4,  ///< running with nobody at the handle, slowly
  kToArmed = 5,     ///< stopping, then held under power: SS2
  kToReady = 6,     ///< stopping, then drives off: SS1
  kToFault = 7,     ///< stopping because of a fault, then drives off
  kFault = 8,
};

inline constexpr std::size_t kStateCount = 9;

/// What can happen. A request is an edge, and granted: what refuses it was looked at before.
enum class Event : std::uint8_t {
  kSample = 0,          ///< a good sample came
  kArm = 1,             ///< requested
  kRun = 2,             ///< requested
  kRunAlone = 3,        ///< requested: autonomously
  kStop = 4,            ///< requested
  kReset = 5,           ///< requested
  kHandOpens = 6,       ///< nobody holds the handle
  kHandCloses = 7,      ///< somebody holds the handle
  kKeyTurnsOff = 8,     ///< the override key is not turned
  kOperatorLetsGo = 9,  ///< the enabling switch is not held
  kStandstill = 10,     ///< a stopping device stands still
  kRule = 11,           ///< a rule is broken whose reaction is a controlled stop
  kHardRule = 12,       ///< one whose reaction is STO
};

inline constexpr std::size_t kEventCount = 13;

/// What an event does to a state: another one, or nothing, or it is refused.
struct Transition {
  State next;
  Refusal refusal = Refusal::kNone;  ///< of a request; then `next` is the present state
};

constexpr Mode mode_of(State state) noexcept {
  constexpr std::array<Mode, kStateCount> kModes = {
      Mode::kOff,      Mode::kReady,    Mode::kArmed,    Mode::kRunning, Mode::kRunning,
      Mode::kStopping, Mode::kStopping, Mode::kStopping, Mode::kFault};
  return kModes[static_cast<std::size_t>(state)];
}

/// Drives are on and brakes open.
constexpr bool is_powered(State state) noexcept {
  return state != State::kOff && state != State::kReady && state != State::kFault;
}

std::string_view to_string(State state) noexcept;
std::string_view to_string(Event event) noexcept;

/// What `event` does to `state`.
const Transition& transition(State state, Event event) noexcept;

}  // namespace hg::safety
