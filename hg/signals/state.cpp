#include "hg/signals/state.h"

namespace hg {

std::string_view to_string(Mode mode) noexcept {
  switch (mode) {
    case Mode::kOff:
      return "off";
    case Mode::kReady:
      return "ready";
    case Mode::kArmed:
      return "armed";
    case Mode::kRunning:
      return "running";
    case Mode::kStopping:
      return "stopping";
    case Mode::kFault:
      return "fault";
  }
  return "unknown";
}

std::string_view to_string(Stop stop) noexcept {
  switch (stop) {
    case Stop::kNone:
      return "none";
    case Stop::kSs2:
      return "SS2";
    case Stop::kSs1:
      return "SS1";
    case Stop::kSto:
      return "STO";
  }
  return "unknown";
}

std::string_view to_string(SolverStatus status) noexcept {
  switch (status) {
    case SolverStatus::kNotRun:
      return "not run";
    case SolverStatus::kSolved:
      return "solved";
    case SolverStatus::kBudgetSpent:
      return "budget spent";
    case SolverStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

std::string_view to_string(TareStatus status) noexcept {
  switch (status) {
    case TareStatus::kNone:
      return "none";
    case TareStatus::kUnderWay:
      return "under way";
    case TareStatus::kDone:
      return "done";
    case TareStatus::kRefusedHeld:
      return "refused: the handle is held, let go of the dead-man";
    case TareStatus::kRefusedMoving:
      return "refused: the device moves";
    case TareStatus::kRefusedUnsteady:
      return "refused: the wrench is not steady, do not touch the handle";
    case TareStatus::kRefusedRunning:
      return "refused: the device runs";
  }
  return "unknown";
}

std::string_view to_string(Refusal refusal) noexcept {
  switch (refusal) {
    case Refusal::kNone:
      return "none";
    case Refusal::kNotTared:
      return "not armed: this device needs a tare first";
    case Refusal::kLatencyTooLong:
      return "not armed: the torque loop is not stable at the latency that was measured";
    case Refusal::kLatencyUnknown:
      return "not armed: the latency of the torque loop is unknown, the device has not answered "
             "100 commands (answered_sequence of its samples)";
    case Refusal::kNotReady:
      return "not armed: the device is not ready, only a device at rest with its drives off is";
    case Refusal::kNotArmed:
      return "not started: the device is not armed";
    case Refusal::kFaultPresent:
      return "refused: there is a fault, reset it first";
    case Refusal::kCauseRemains:
      return "not reset: the cause of the fault is still there";
    case Refusal::kNoFault:
      return "not reset: there is no fault";
    case Refusal::kOperatorReleased:
      return "not armed: the operator does not hold the enabling switch";
    case Refusal::kNobodyHolds:
      return "not started: the handle is not held";
    case Refusal::kSomebodyHolds:
      return "not started: the handle is held, let go of it to run without a hand";
    case Refusal::kNoOverride:
      return "not started: to run without a hand the override key must be turned";
    case Refusal::kFieldOccupied:
      return "not started: a person is in the scanner's field";
    case Refusal::kStillMoving:
      return "not armed: the device still moves";
    case Refusal::kTwinApart:
      return "not armed: the twin cannot be where the handle is; bring the handle back (a remote "
             "device: is it of the same scenario?)";
    case Refusal::kPostureImplausible:
      return "not armed: accelerometer and encoders give different postures; is every joint "
             "homed?";
  }
  return "unknown";
}

}  // namespace hg
