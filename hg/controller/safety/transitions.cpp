#include "hg/controller/safety/transitions.h"

#include "hg/core/index.h"

namespace hg::safety {
namespace {

using enum SafetyState;

using Row = std::array<Transition, kEventCount>;

constexpr Transition not_ready_in(SafetyState state) { return {state, Refusal::kNotReady}; }
constexpr Transition not_armed_in(SafetyState state) { return {state, Refusal::kNotArmed}; }
constexpr Transition no_fault_in(SafetyState state) { return {state, Refusal::kNoFault}; }
constexpr Transition reset_first_in(SafetyState state) { return {state, Refusal::kFaultPresent}; }

// Columns in the order of SafetyEvent: sample | arm, run, run alone, stop, reset | hand opens, hand
// closes, key turns off, operator lets go | standstill | rule, hard rule
constexpr std::array<Row, kStateCount> kTable = {{
    // off
    {{{kReady},
      not_ready_in(kOff),
      not_armed_in(kOff),
      not_armed_in(kOff),
      {kOff},
      no_fault_in(kOff),
      {kOff},
      {kOff},
      {kOff},
      {kOff},
      {kOff},
      {kFault},
      {kFault}}},
    // ready
    {{{kReady},
      {kArmed},
      not_armed_in(kReady),
      not_armed_in(kReady),
      {kReady},
      no_fault_in(kReady),
      {kReady},
      {kReady},
      {kReady},
      {kReady},
      {kReady},
      {kFault},
      {kFault}}},
    // armed: at rest already
    {{{kArmed},
      not_ready_in(kArmed),
      {kByHand},
      {kAutonomous},
      {kReady},
      no_fault_in(kArmed),
      {kArmed},
      {kArmed},
      {kArmed},
      {kReady},
      {kArmed},
      {kFault},
      {kFault}}},
    // running by hand
    {{{kByHand},
      not_ready_in(kByHand),
      not_armed_in(kByHand),
      not_armed_in(kByHand),
      {kToArmed},
      no_fault_in(kByHand),
      {kToArmed},
      {kByHand},
      {kByHand},
      {kToReady},
      {kByHand},
      {kToFault},
      {kFault}}},
    // running autonomously
    {{{kAutonomous},
      not_ready_in(kAutonomous),
      not_armed_in(kAutonomous),
      not_armed_in(kAutonomous),
      {kToArmed},
      no_fault_in(kAutonomous),
      {kAutonomous},
      {kToArmed},
      {kToArmed},
      {kToReady},
      {kAutonomous},
      {kToFault},
      {kFault}}},
    // stopping, then armed
    {{{kToArmed},
      not_ready_in(kToArmed),
      not_armed_in(kToArmed),
      not_armed_in(kToArmed),
      {kToArmed},
      no_fault_in(kToArmed),
      {kToArmed},
      {kToArmed},
      {kToArmed},
      {kToReady},
      {kArmed},
      {kToFault},
      {kFault}}},
    // stopping, then ready
    {{{kToReady},
      not_ready_in(kToReady),
      not_armed_in(kToReady),
      not_armed_in(kToReady),
      {kToReady},
      no_fault_in(kToReady),
      {kToReady},
      {kToReady},
      {kToReady},
      {kToReady},
      {kReady},
      {kToFault},
      {kFault}}},
    // stopping, then fault
    {{{kToFault},
      reset_first_in(kToFault),
      reset_first_in(kToFault),
      reset_first_in(kToFault),
      {kToFault},
      {kToFault, Refusal::kCauseRemains},
      {kToFault},
      {kToFault},
      {kToFault},
      {kToFault},
      {kFault},
      {kToFault},
      {kFault}}},
    // fault
    {{{kFault},
      reset_first_in(kFault),
      reset_first_in(kFault),
      reset_first_in(kFault),
      {kFault},
      {kReady},
      {kFault},
      {kFault},
      {kFault},
      {kFault},
      {kFault},
      {kFault},
      {kFault}}},
}};

constexpr bool refused_stay() noexcept {
  for (std::size_t state = 0; state < kStateCount; ++state) {
    for (const Transition& cell : kTable[state]) {
      if (cell.refusal != Refusal::kNone && cell.next != static_cast<SafetyState>(state))
        return false;
    }
  }
  return true;
}
static_assert(refused_stay(), "a refused request changes nothing");

}  // namespace

const Transition& transition(SafetyState state, SafetyEvent event) noexcept {
  return kTable[index(state)][index(event)];
}

std::string_view to_string(SafetyState state) noexcept {
  switch (state) {
    case kOff:
      return "off";
    case kReady:
      return "ready";
    case kArmed:
      return "armed";
    case kByHand:
      return "running by hand";
    case kAutonomous:
      return "running autonomously";
    case kToArmed:
      return "stopping, then armed";
    case kToReady:
      return "stopping, then ready";
    case kToFault:
      return "stopping, then fault";
    case kFault:
      return "fault";
  }
  return "unknown";
}

std::string_view to_string(SafetyEvent event) noexcept {
  switch (event) {
    case SafetyEvent::kSample:
      return "good sample";
    case SafetyEvent::kArm:
      return "request: arm";
    case SafetyEvent::kRun:
      return "request: run";
    case SafetyEvent::kRunAlone:
      return "request: run autonomously";
    case SafetyEvent::kStop:
      return "request: stop";
    case SafetyEvent::kReset:
      return "request: reset";
    case SafetyEvent::kHandOpens:
      return "hand lets go";
    case SafetyEvent::kHandCloses:
      return "hand takes hold";
    case SafetyEvent::kKeyTurnsOff:
      return "override key off";
    case SafetyEvent::kOperatorLetsGo:
      return "operator lets go";
    case SafetyEvent::kStandstill:
      return "standstill";
    case SafetyEvent::kRule:
      return "rule with SS1 or SS2";
    case SafetyEvent::kHardRule:
      return "rule with STO";
  }
  return "unknown";
}

}  // namespace hg::safety
