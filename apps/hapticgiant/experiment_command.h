/// `hapticgiant experiment NAME`: what the simulated device is like to hold, measured.
#pragma once

#include <string>

namespace hg::apps {

struct ExperimentArguments {
  std::string json;  ///< file for all figures; empty = none
  std::string svg;   ///< file for the drawing; empty = none
};

/// Each prints to stdout and returns the exit code: 0; bad input is thrown as SetupError.
int experiment_free_space(const ExperimentArguments& arguments);
int experiment_stability_map(const ExperimentArguments& arguments);
int experiment_impedance(const ExperimentArguments& arguments);

}  // namespace hg::apps
