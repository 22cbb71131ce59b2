/// How `hapticgiant haptify` measures, in words for its report.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hg/haptify/figures.h"

namespace hg::apps {

/// Stands wherever figures of both stand side by side.
inline constexpr std::string_view kRealAndSimulated =
    "The paper's HapticGiant, Touch and Touch X were real machines in real hands; ours is a "
    "simulated machine with assumed friction, noise and delays in a simulated hand.";

/// One sentence or two per measurement, with the conditions of this one.
std::vector<std::string> method_of(const haptify::Benchmark& result);

}  // namespace hg::apps
