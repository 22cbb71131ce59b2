/// Progress display of long tasks.
#pragma once

#include <string>

#include "hg/experiments/workers.h"

namespace hg::apps {

/// Callback that shows "WHAT: 12 of 180" in place on a terminal; elsewhere it shows nothing.
experiments::Progress progress_of(const std::string& what);

}  // namespace hg::apps
