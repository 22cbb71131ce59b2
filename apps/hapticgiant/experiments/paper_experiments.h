/// The experiments of the paper as data: what runs, when each event is expected, and why.
#pragma once

#include <span>
#include <string_view>

namespace hg::apps {

/// When the script provokes an event. The same event at another time would not be the one that was
/// asked for.
struct EventWindow {
  std::string_view event;    ///< name of the scenario's rule
  double from_s, to_s;       ///< time of the script: counts from when the hand takes the handle
  std::string_view because;  ///< what the person does then
};

struct PaperExperiment {
  std::string_view name;      ///< of the subcommand, and of the figure's panels
  std::string_view scenario;  ///< models/scenarios
  std::string_view title;
  std::string_view source;  ///< where in the paper
  std::string_view about;   ///< one or two sentences for the report
  std::span<const EventWindow> windows;
  std::string_view comment;  ///< on what differs from the paper
};

/// In the order of the paper.
std::span<const PaperExperiment> paper_experiments();

/// Throws SetupError with the nearest name.
const PaperExperiment& paper_experiment(std::string_view name);

}  // namespace hg::apps
