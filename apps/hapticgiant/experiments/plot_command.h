/// `hapticgiant plot FILE...`: figures of recordings.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

struct PlotArguments {
  std::vector<std::string> files;
  std::string out = "plots";
};

/// Exit code 0, also without matplotlib: then only signals are written, and a line explains how to
/// get figures. Throws SetupError for bad input.
int plot(const PlotArguments& arguments);

}  // namespace hg::apps
