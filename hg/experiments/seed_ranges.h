/// Results of scenarios over many seeds of sensor errors, noise and tremor. One seed says little
/// about a limit that is met once.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/workers.h"
#include "hg/signals/fault.h"

namespace hg::experiments {

/// A scenario with a hand.
struct Trial {
  std::string name;
  std::string hand;  ///< preset of the hand; empty = the hand of the scenario
  config::Scenario scenario;
};

/// Largest true excess over one limit.
struct WorstLimit {
  double excess = 0.0;  ///< excess, rad or m
  std::string name;     ///< name of the limit; empty = none was exceeded
};

/// Result of a trial with one seed.
struct SeededRun {
  std::size_t trial = 0;  ///< index of the trial
  std::uint64_t seed = 0;
  Fault fault;
  double ended_s = 0.0;
  bool has_held = false;         ///< no fault, all limits within Summary::limits_held()
  std::size_t missing = 0;       ///< number of expected events that did not happen
  WorstLimit angle, length;      ///< largest true excess, rad and m
  double joint_error = 0.0;      ///< largest difference of true link and reference, rad
  double handle_distance = 0.0;  ///< largest distance of true handle and twin, m
  double torque_share = 0.0;     ///< largest motor torque over its peak; 0 without torque control
  double mean_force = 0.0;       ///< mean force of the person, N
  double vibration = 0.0;        ///< rms of the handle's acceleration above 5 Hz, m/s^2
};

/// Plays every trial with the seeds first .. first + count - 1, on all cores. Runs are in the order
/// of trials, then seeds. Throws SetupError for a scenario that no script plays.
std::vector<SeededRun> play_seeds(const std::vector<Trial>& trials, std::uint64_t first, int count,
                                  const Progress& progress);

/// Whether no run ended in a fault or left a limit.
bool have_all_held(const std::vector<SeededRun>& runs);

/// Results for python/hapticgiant/report/series.py.
nlohmann::ordered_json to_json(const std::vector<Trial>& trials,
                               const std::vector<SeededRun>& runs);

}  // namespace hg::experiments
