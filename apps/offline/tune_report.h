/// Results of `tune` as JSON; python/hapticgiant/report/tuning.py makes text and figure of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hg/tune/search.h"

namespace hg::apps {

struct TuneReport {
  const tune::TuningProblem& problem;
  const tune::TuningResult& result;  ///< result; the first of its front is the requested one
  tune::Demands demands;
  std::string name, command;
};

/// Figures, proofs and values before and after, felt over rendered impedance, and how far each
/// posture is from its limits. With an empty front: only the present values.
nlohmann::ordered_json tune_json(const TuneReport& report);

}  // namespace hg::apps
