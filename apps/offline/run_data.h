/// What a report needs of a run: run.json, about its scenario and its events, and signals.npy, the
/// columns of a recording that figures and measures are made of. python/hapticgiant/report/runs.py
/// reads both.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/recording/columns.h"
#include "hg/signals/event_rule.h"

namespace hg::apps {

/// Names of the columns in signals.npy.
std::vector<std::string> signal_names();

/// Device, twin and limits of a scenario, with names and units.
nlohmann::ordered_json describe(const config::Scenario& scenario);

/// An expected event with its conditions: {"name", "what", "all_of": [{"kind", "of", "side",
/// "value", ...}]}.
nlohmann::ordered_json describe(const EventRule& rule, const config::Scenario& scenario);

/// Origins of the links in B of a twin at `q_a`, m, root first; null for a twin that floats.
nlohmann::ordered_json twin_points(const config::Scenario& scenario, const ConfigurationA& q_a);

/// Writes run.json and signals.npy into a folder. Throws SetupError.
void write_run(const std::filesystem::path& folder, const nlohmann::ordered_json& run,
               const recording::Columns& columns);

}  // namespace hg::apps
