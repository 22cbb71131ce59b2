/// The experiments of the paper as data: scenario, expected time of each event, and reason.
#pragma once

#include <span>
#include <string_view>

namespace hg::apps {

/// Time window in which the script provokes an event. The same event at another time does not
/// count.
struct EventWindow {
  std::string_view event;    ///< event, by the name of the scenario's rule
  double from_s, to_s;       ///< window in time of the script, counted from the grasp
  std::string_view because;  ///< action of the person at that time
};

struct PaperExperiment {
  std::string_view name;      ///< name of the subcommand and of the figure's panels
  std::string_view scenario;  ///< scenario in models/scenarios
  std::string_view title;
  std::string_view source;  ///< place in the paper
  std::string_view about;   ///< description in one or two sentences, for the report
  std::span<const EventWindow> windows;
  std::string_view comment;  ///< comment on differences from the paper
};

/// All experiments, in the order of the paper.
std::span<const PaperExperiment> paper_experiments();

/// Finds an experiment by name. Throws SetupError with the nearest name.
const PaperExperiment& paper_experiment(std::string_view name);

}  // namespace hg::apps
