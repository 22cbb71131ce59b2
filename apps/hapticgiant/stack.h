/// The stacks of the program's threads.
#pragma once

#include <string>

namespace hg::apps {

/// Raises a small stack limit of the system (ulimit -s) as far as permitted, for all threads
/// created afterwards. Returns an error text if that is not enough, else empty. Call it first.
std::string provide_stack();

}  // namespace hg::apps
