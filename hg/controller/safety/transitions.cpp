#include "hg/controller/safety/transitions.h"

namespace hg::safety {
namespace {

using enum State;

using Row = std::array<Transition, kEventCount>;

constexpr Transition not_ready_in(State state) { return {state, Refusal::kNotReady}; }
constexpr Transition not_armed_in(State state) { return {state, Refusal::kNotArmed}; }
constexpr Transition no_fault_in(State state) { return {state, Refusal::kNoFault}; }
constexpr Transition reset_first_in(State state) { return {state, Refusal::kFaultPresent}; }

// Columns in the order of Event: sample | arm, run, run alone, stop, reset | hand opens, hand
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
      if (cell.refusal != Refusal::kNone && cell.next != static_cast<State>(state)) return false;
    }
  }
  return true;
}
static_assert(refused_stay(), "a refused request changes nothing");

}  // namespace

const Transition& transition(State state, Event event) noexcept {
  return kTable[static_cast<std::size_t>(state)][static_cast<std::size_t>(event)];
}

std::string_view to_string(State state) noexcept {
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

std::string_view to_string(Event event) noexcept {
  switch (event) {
    case Event::kSample:
      return "good sample";
    case Event::kArm:
      return "request: arm";
    case Event::kRun:
      return "request: run";
    case Event::kRunAlone:
      return "request: run autonomously";
    case Event::kStop:
      return "request: stop";
    case Event::kReset:
      return "request: reset";
    case Event::kHandOpens:
      return "hand lets go";
    case Event::kHandCloses:
      return "hand takes hold";
    case Event::kKeyTurnsOff:
      return "override key off";
    case Event::kOperatorLetsGo:
      return "operator lets go";
    case Event::kStandstill:
      return "standstill";
    case Event::kRule:
      return "rule with SS1 or SS2";
    case Event::kHardRule:
      return "rule with STO";
  }
  return "unknown";
}

}  // namespace hg::safety
