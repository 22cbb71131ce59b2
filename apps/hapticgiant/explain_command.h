/// Tells in words what happened in a recording.
#pragma once

#include <string>

namespace hg::apps {

/// Exit code 0. Throws SetupError for bad input.
int explain_recording(const std::string& file);

}  // namespace hg::apps
