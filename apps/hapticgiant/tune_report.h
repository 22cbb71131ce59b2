/// What `tune` leaves behind.
#pragma once

#include <string>

#include "hg/tuning/search.h"

namespace hg::apps {

/// A report with its command, and the lines for device.yaml.
struct TuneReport {
  const tuning::Problem& problem;
  const tuning::Result& result;
  std::string name, command;
};

/// Before and after, for a terminal; `chosen` of the front.
std::string tune_text(const TuneReport& report, std::size_t chosen);
/// Lines for device.yaml, with the figures behind them.
std::string tune_yaml(const TuneReport& report, std::size_t chosen);
/// A page of all that.
std::string tune_markdown(const TuneReport& report, std::size_t chosen);
/// One row per loop: limit, figures, proof, values.
std::string tune_csv(const TuneReport& report);
/// Transparency and latency over vibration.
std::string tune_svg(const TuneReport& report);

}  // namespace hg::apps
