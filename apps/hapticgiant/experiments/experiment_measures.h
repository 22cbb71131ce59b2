/// What an experiment shows, in figures: beside what the paper says about the same thing.
#pragma once

#include <string>
#include <vector>

#include "apps/hapticgiant/experiments/experiment_run.h"

namespace hg::apps {

struct Statement {
  std::string what;   ///< is looked at
  std::string paper;  ///< what the paper says; empty = nothing
  std::string ours;   ///< measured in this run; "-" where an event is missing
};

/// Of a run whose events may be missing. Checkpoints that were passed too far away become failures
/// of `result`.
std::vector<Statement> measure(ExperimentResult& result);

}  // namespace hg::apps
