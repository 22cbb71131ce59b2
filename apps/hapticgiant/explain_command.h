/// `hapticgiant explain`: describes a recorded run in words.
#pragma once

#include <string>

namespace hg::apps {

/// Explains a recording on stdout. Exit code 0. Throws SetupError for bad input.
int explain_recording(const std::string& file);

}  // namespace hg::apps
