/// Both laws with both kinds of bounds on the same scenarios, as one table.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

struct BenchArguments {
  std::vector<std::string> scenarios = {"door", "free_space", "excavator"};
  std::string json;  ///< file; empty = none
};

/// Plays every scenario with each law and each kind of bounds, without page and recording. The
/// solver is timed on the problem of every cycle that renders, from the active set of the cycle
/// before. Exit code 0, or 1 when an expected event is missing, a device was stopped by a fault or
/// a cycle was not solved. Throws SetupError for bad input.
int bench(const BenchArguments& arguments);

}  // namespace hg::apps
