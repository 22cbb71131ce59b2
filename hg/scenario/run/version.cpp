#include "hg/scenario/run/version.h"

namespace hg::scenario {

const char* version() noexcept { return HG_VERSION; }

}  // namespace hg::scenario
