/// Programs of ours beside this one, named after it: hapticgiant-NAME.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

/// Replaces this process by hapticgiant-`name` with these arguments. Returns only by SetupError:
/// where the program is missing, that of `missing` ("bridge ros2: off") and where to get it
/// (`source`).
[[noreturn]] void become_sibling(const std::string& name, const std::vector<std::string>& arguments,
                                 const std::string& missing, const std::string& source);

}  // namespace hg::apps
