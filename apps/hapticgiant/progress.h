/// How far long work has come, for those who watch.
#pragma once

#include <string>

#include "hg/experiments/workers.h"

namespace hg::apps {

/// "WHAT: 12 of 180" in place on a terminal; nobody elsewhere.
experiments::Progress progress_of(const std::string& what);

}  // namespace hg::apps
