#include "hg/runtime/requests.h"

namespace hg::runtime {

ModeRequest next_request(Mode mode, bool is_held, bool is_stopping) noexcept {
  switch (mode) {
    case Mode::kReady:
      return ModeRequest::kArm;
    case Mode::kArmed:
      return is_held && !is_stopping ? ModeRequest::kRun : ModeRequest::kNone;
    case Mode::kRunning:
      return is_stopping ? ModeRequest::kStop : ModeRequest::kNone;
    case Mode::kOff:
    case Mode::kStopping:
    case Mode::kFault:
      return ModeRequest::kNone;
  }
  return ModeRequest::kNone;
}

}  // namespace hg::runtime
