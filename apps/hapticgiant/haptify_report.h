/// Results of the benchmark for a terminal and for the report program.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hg/studies/haptify/figures.h"

namespace hg::apps {

/// The table of goals.h for a terminal, and the failures.
std::string goals_text(const haptify::Benchmark& goals);

/// The benchmark for a terminal: table, missed goals, failures.
std::string haptify_text(const haptify::Benchmark& result);

/// Everything measured, for python/hapticgiant/report, without time and place: the same figures
/// give the same text. `kind` is "haptify" or "goals"; `command` reproduces it.
nlohmann::ordered_json results_json(const haptify::Benchmark& result, const std::string& kind,
                                    const std::string& command);

}  // namespace hg::apps
