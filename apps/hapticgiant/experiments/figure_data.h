/// Data for the figures of a run besides its signals: the file run.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/hapticgiant/experiments/run_table.h"
#include "hg/config/simulation/scenario.h"

namespace hg::apps {

/// Mark of an event in a figure.
struct Mark {
  std::string label;
  double time_s = 0.0;
  std::string what;
};

/// `kind`: "cartesian", "excavator", "door" or "path", the panels of that figure; "any": all there
/// are. `note` says where the data comes from.
nlohmann::ordered_json figure_data(const config::Scenario& scenario, const RunTable& table,
                                   const std::vector<Mark>& marks, const std::string& kind,
                                   const std::string& note);

/// Seconds per row of the file signals.csv that figures are drawn from.
inline constexpr double kFigurePeriod_s = 0.01;

}  // namespace hg::apps
