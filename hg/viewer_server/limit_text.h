/// Limits and modes in words for people.
#pragma once

#include <string>

#include "hg/signals/limit.h"
#include "hg/signals/state.h"

namespace hg::viewer_server {

/// For example "elbow x: upper limit, 23 N" or "hinge: locked, 4.1 Nm".
std::string limit_text(const LimitInfo& info, const LimitReport& report);

/// The mode and why, for example "ready: the force/torque sensor is being tared".
std::string mode_text(const CycleRecord& record);

}  // namespace hg::viewer_server
