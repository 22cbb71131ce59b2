/// Progress display of long tasks.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace hg::apps {

using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Callback that shows "WHAT: 12 of 180" in place on a terminal; elsewhere it shows nothing.
Progress progress_of(const std::string& what);

}  // namespace hg::apps
