/// What `tune` leaves behind.
#pragma once

#include <string>

#include "hg/tuning/search.h"

namespace hg::apps {

/// A report with its command, and the lines for device.yaml.
struct TuneReport {
  const tuning::Problem& problem;
  const tuning::Result& result;  ///< the first of its front is what was asked for
  tuning::Demands demands;
  std::string name, command;
};

/// What the device has now, for a terminal; nothing else of the result need be there.
std::string tune_check_text(const TuneReport& report);
/// Before and after, for a terminal.
std::string tune_text(const TuneReport& report);
/// Lines for device.yaml, with the figures behind them.
std::string tune_yaml(const TuneReport& report);
/// A page of all that.
std::string tune_markdown(const TuneReport& report);
/// One row per loop: limit, figures, proof, values.
std::string tune_csv(const TuneReport& report);
/// run.json of its figure (figure_program.h): what is felt over what is rendered, the front, and
/// how far each posture is from its limits.
std::string tune_figure(const TuneReport& report);

}  // namespace hg::apps
