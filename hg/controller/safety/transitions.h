/// Operating states and allowed transitions, as data: advance() follows them, and the table of
/// docs/concepts/safety.md is generated from them.
///
/// Source: [HANDBOOK] 6.5, docs/concepts/safety.md. Every transition to a state with power needs an
/// edge of a request.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hg/core/index.h"
#include "hg/signals/state.h"

namespace hg::safety {

/// Operating state: the mode and the details that the supervisor needs. Numbers are hashed and
/// never change.
enum class SafetyState : std::uint8_t {
  kOff = 0,
  kReady = 1,
  kArmed = 2,
  kByHand = 3,      ///< running while the user holds the handle
  kAutonomous = 4,  ///< running with a released handle, slowly
  kToArmed = 5,     ///< stopping, then held under power: SS2
  kToReady = 6,     ///< stopping, then drives off: SS1
  kToFault = 7,     ///< stopping because of a fault, then drives off
  kFault = 8,
};

inline constexpr std::size_t kStateCount = 9;

/// Events of the state machine. A request is an edge whose other conditions have been checked.
enum class SafetyEvent : std::uint8_t {
  kSample = 0,          ///< a valid sample arrived
  kArm = 1,             ///< arming requested
  kRun = 2,             ///< running by hand requested
  kRunAlone = 3,        ///< autonomous running requested
  kStop = 4,            ///< stop requested
  kReset = 5,           ///< reset requested
  kHandOpens = 6,       ///< the handle is not held
  kHandCloses = 7,      ///< the handle is held
  kKeyTurnsOff = 8,     ///< the override key is not turned
  kOperatorLetsGo = 9,  ///< the enabling switch is not held
  kStandstill = 10,     ///< a stopping device is at rest
  kRule = 11,           ///< a rule is broken whose reaction is a controlled stop
  kHardRule = 12,       ///< a rule is broken whose reaction is STO
};

inline constexpr std::size_t kEventCount = 13;

/// Effect of an event on a state: next state, no change, or refusal.
struct Transition {
  SafetyState next;
  Refusal refusal = Refusal::kNone;  ///< Refusal of a request; `next` is then the present state
};

constexpr Mode mode_of(SafetyState state) noexcept {
  constexpr std::array<Mode, kStateCount> kModes = {
      Mode::kOff,      Mode::kReady,    Mode::kArmed,    Mode::kRunning, Mode::kRunning,
      Mode::kStopping, Mode::kStopping, Mode::kStopping, Mode::kFault};
  return kModes[index(state)];
}

/// Whether drives are on and brakes open.
constexpr bool is_powered(SafetyState state) noexcept {
  return state != SafetyState::kOff && state != SafetyState::kReady && state != SafetyState::kFault;
}

std::string_view to_string(SafetyState state) noexcept;
std::string_view to_string(SafetyEvent event) noexcept;

/// Transition of `state` at `event`.
const Transition& transition(SafetyState state, SafetyEvent event) noexcept;

}  // namespace hg::safety
