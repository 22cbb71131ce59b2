/// `hapticgiant experiment NAME`: what the simulated device is like to hold, measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hg::apps {

struct ExperimentArguments {
  std::string json;                ///< file for all figures; empty = none
  std::string svg;                 ///< file for the drawing; empty = none
  std::string device, simulation;  ///< files instead of those of the scenario; empty = those
};

struct ContactArguments {
  std::string json;  ///< file for all figures; empty = none
  std::string docs;  ///< folder of documentation to refresh; empty = none
  int seeds = 4;
};

struct InertialArguments {
  std::vector<std::string> scenarios = {"walk", "door"};
  std::string simulation;  ///< see find_simulation(); empty = as the device says
  int seeds = 4;
  bool feels = false;  ///< also what a hand feels of it
  std::string json;    ///< file for all figures; empty = none
};

struct SeedsArguments {
  std::vector<std::string> scenarios = {"door", "free_space", "excavator", "walk"};
  std::vector<std::string> hands = {"own"};  ///< or presets
  int count = 16;
  std::uint64_t first = 1;
  std::string law;       ///< "gauss" or "paper"; empty = the device's
  std::string bounds;    ///< "recoverable" or "paper"; likewise
  std::string gantry;    ///< "law" or "rule"; empty = the device's
  std::string braking;   ///< "alone" or "together"; empty = the device's
  std::string json;      ///< file for all runs; empty = none
  std::string markdown;  ///< file for the table; empty = none
};

/// Each prints to stdout and returns the exit code: 0; bad input is thrown as SetupError.
int experiment_free_space(const ExperimentArguments& arguments);
int experiment_stability_map(const ExperimentArguments& arguments);
int experiment_impedance(const ExperimentArguments& arguments);
int experiment_contact(const ContactArguments& arguments);
int experiment_inertial(const InertialArguments& arguments);
/// Exit code 1 when a run ended in a fault or left a limit.
int experiment_seeds(const SeedsArguments& arguments);

}  // namespace hg::apps
