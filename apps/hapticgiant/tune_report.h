/// Reports of `tune`.
#pragma once

#include <string>

#include "hg/studies/tuning/search.h"

namespace hg::apps {

/// A report with its command, and the lines for device.yaml.
struct TuneReport {
  const tuning::TuningProblem& problem;
  const tuning::TuningResult& result;  ///< result; the first of its front is the requested one
  tuning::Demands demands;
  std::string name, command;
};

/// Present values of the device, for a terminal; the rest of the result may be missing.
std::string tune_check_text(const TuneReport& report);
/// Comparison before and after, for a terminal.
std::string tune_text(const TuneReport& report);
/// Lines for device.yaml, with the figures behind them.
std::string tune_yaml(const TuneReport& report);
/// The whole report as a Markdown page.
std::string tune_markdown(const TuneReport& report);
/// CSV with one row per loop: limit, figures, proof, values.
std::string tune_csv(const TuneReport& report);
/// run.json of its figure (figure_program.h): felt over rendered impedance, the front, and how far
/// each posture is from its limits.
std::string tune_figure(const TuneReport& report);

}  // namespace hg::apps
