#include "hg/control/tracking.h"

namespace hg::control {

void track(const ReferenceState& reference, CommandFrame& command) noexcept {
  command.q_m = reference.q_m;
  command.dq_m = reference.dq_m;
  command.ddq_m = reference.ddq_m;
}

}  // namespace hg::control
