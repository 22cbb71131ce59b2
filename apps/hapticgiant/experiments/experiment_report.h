/// Reports of an experiment, for people and scripts.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/hapticgiant/experiments/experiment_measures.h"
#include "apps/hapticgiant/experiments/experiment_run.h"

namespace hg::apps {

/// One run of an experiment with its measurements.
struct ReportedRun {
  std::string law;
  ExperimentResult result;
  std::vector<Statement> statements;
};

/// JSON of every expected event: label, condition in words and as data, when it was expected, when
/// it was found.
nlohmann::ordered_json events_json(const ReportedRun& run);

/// JSON of summary, statements and verdict.
nlohmann::ordered_json results_json(const ReportedRun& run);

/// One page for all runs of the same experiment, side by side; `folder` holds figure.svg.
std::string report_html(const std::vector<ReportedRun>& runs, const std::filesystem::path& folder,
                        const std::string& command);

/// The report as Markdown tables for docs/experiments/.
std::string report_markdown(const std::vector<ReportedRun>& runs, const std::string& command);

/// Note on a run: "gauss law, recoverable bounds, seed 1, simulated HapticGiant".
std::string run_note(const ExperimentResult& result);

}  // namespace hg::apps
