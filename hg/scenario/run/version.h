/// Version of this build.
#pragma once

namespace hg::scenario {

/// As in "0.2.0".
const char* version() noexcept;

}  // namespace hg::scenario
