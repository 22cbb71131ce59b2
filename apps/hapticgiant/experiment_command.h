/// `hapticgiant experiment NAME`: measures how the simulated device feels at the handle.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hg::apps {

struct ExperimentArguments {
  std::string json;  ///< file for all figures; empty = none
  std::string svg;   ///< file for the drawing; empty = none
  /// Files that replace those of the scenario; empty = those of the scenario
  std::string device, simulation;
};

struct ContactArguments {
  std::string json;  ///< file for all figures; empty = none
  std::string docs;  ///< folder of documentation to refresh; empty = none
  int seeds = 4;
};

struct InertialArguments {
  std::vector<std::string> scenarios = {"walk", "door"};
  std::string simulation;  ///< simulation, see find_simulation(); empty = that of the device
  int seeds = 4;
  bool feels = false;  ///< also measures what a hand feels
  std::string json;    ///< file for all figures; empty = none
};

struct SeedsArguments {
  std::vector<std::string> scenarios = {"door", "free_space", "excavator", "walk"};
  std::vector<std::string> hands = {"own"};  ///< hands: "own" or presets
  int count = 16;
  std::uint64_t first = 1;
  std::string law;       ///< law, "gauss" or "paper"; empty = the device's
  std::string bounds;    ///< bounds, "recoverable" or "paper"; empty = the device's
  std::string gantry;    ///< guidance of the gantry, "law" or "rule"; empty = the device's
  std::string braking;   ///< braking, "alone" or "together"; empty = the device's
  std::string json;      ///< file for all runs; empty = none
  std::string markdown;  ///< file for the table; empty = none
};

/// Each experiment prints to stdout and returns exit code 0. Throws SetupError for bad input.
int experiment_free_space(const ExperimentArguments& arguments);
int experiment_stability_map(const ExperimentArguments& arguments);
int experiment_impedance(const ExperimentArguments& arguments);
int experiment_contact(const ContactArguments& arguments);
int experiment_inertial(const InertialArguments& arguments);
/// Runs the seeds. Exit code 1 when a run ended in a fault or left a limit.
int experiment_seeds(const SeedsArguments& arguments);

/// Adds the subcommands to the program; running it sets `exit_code`.
void add_experiment(CLI::App& app, int& exit_code);

}  // namespace hg::apps
