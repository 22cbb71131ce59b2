/// Measured results of an experiment, compared with the paper.
#pragma once

#include <string>
#include <vector>

#include "apps/hapticgiant/experiments/experiment_run.h"

namespace hg::apps {

struct Statement {
  std::string what;   ///< measured quantity
  std::string paper;  ///< value in the paper; empty = none
  std::string ours;   ///< value measured in this run; "-" where an event is missing
};

/// Measures a run whose events may be missing. Checkpoints passed at too large a distance become
/// failures of `result`.
std::vector<Statement> measure(ExperimentResult& result);

}  // namespace hg::apps
