/// Limits and modes as readable text.
#pragma once

#include <string>

#include "hg/signals/limit.h"
#include "hg/signals/state.h"

namespace hg::viewer_server {

/// Text of a limit's state, for example "elbow x: upper limit, 23 N" or "hinge: locked, 4.1 Nm".
std::string limit_text(const LimitInfo& info, const LimitReport& report);

/// Text of the mode and its cause, for example "ready: the force/torque sensor is being tared".
std::string mode_text(const CycleRecord& record);

}  // namespace hg::viewer_server
