/// The stacks of the program's threads.
#pragma once

#include <string>

namespace hg::apps {

/// Raises a small limit of the system (ulimit -s) as far as it may, for all threads from now on.
/// Returns what is missing where that is not enough; empty: it is. Call it first.
std::string provide_stack();

}  // namespace hg::apps
