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

std::string_view to_string(SolverStatus status) noexcept {
  switch (status) {
    case SolverStatus::kNotRun:
      return "not run";
    case SolverStatus::kSolved:
      return "solved";
    case SolverStatus::kIterationLimit:
      return "iteration limit";
    case SolverStatus::kFailed:
      return "failed";
  }
  return "unknown";
}

}  // namespace hg
