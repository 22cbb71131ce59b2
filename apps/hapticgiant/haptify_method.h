/// Description of the methods of `hapticgiant haptify` for its report.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hg/studies/haptify/figures.h"

namespace hg::apps {

/// Note shown wherever figures of real and simulated devices are side by side.
inline constexpr std::string_view kRealAndSimulated =
    "The paper's HapticGiant, Touch and Touch X were real machines in real hands; ours is a "
    "simulated machine with assumed friction, noise and delays in a simulated hand.";

/// One or two sentences per measurement, with the conditions of this result.
std::vector<std::string> method_of(const haptify::Benchmark& result);

}  // namespace hg::apps
