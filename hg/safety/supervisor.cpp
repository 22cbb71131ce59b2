#include "hg/safety/supervisor.h"

namespace hg::safety {

void advance(SupervisorState& state, ModeRequest request, bool dead_man,
             const Fault& fault) noexcept {
  const bool is_edge = request != state.last_request;
  state.last_request = request;
  if (fault.code != FaultCode::kNone) {
    if (state.mode != Mode::kFault) state.fault = fault;
    state.mode = Mode::kFault;
    return;
  }
  const bool arm = is_edge && request == ModeRequest::kArm;
  const bool run = is_edge && request == ModeRequest::kRun;
  const bool stop = is_edge && request == ModeRequest::kStop;
  const bool reset = is_edge && request == ModeRequest::kReset;
  switch (state.mode) {
    case Mode::kOff:
      state.mode = Mode::kReady;
      break;
    case Mode::kReady:
      if (arm) state.mode = Mode::kArmed;
      break;
    case Mode::kArmed:
      if (run && dead_man) state.mode = Mode::kRunning;
      if (stop) state.mode = Mode::kReady;
      break;
    case Mode::kRunning:
      if (stop || !dead_man) state.mode = Mode::kStopping;
      break;
    case Mode::kStopping:
      break;  // ends when the reference stands still, see has_stopped()
    case Mode::kFault:
      if (reset) {
        state.mode = Mode::kReady;
        state.fault = {};
      }
      break;
  }
}

void has_stopped(SupervisorState& state) noexcept {
  if (state.mode == Mode::kStopping) state.mode = Mode::kArmed;
}

}  // namespace hg::safety
