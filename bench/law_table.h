/// Comparison of both laws with both kinds of bounds on the same scenario.
#pragma once

#include <string>
#include <vector>

#include "bench/times.h"
#include "hg/analysis/summary.h"
#include "hg/config/simulation/scenario.h"

namespace hg::bench {

/// Results of a scenario under one law; accelerations of the hand in m/s^2.
struct LawRun {
  std::string scenario, law, bounds;
  std::size_t events = 0, expected_events = 0;
  std::vector<std::string> missing;
  FaultCode fault = FaultCode::kNone;
  int cycles = 0;  ///< number of rendering cycles
  int unsolved = 0;
  double duration_s = 0.0;
  int changes = 0;         ///< number of limits that begin or cease to act
  int changed_cycles = 0;  ///< number of cycles in which a limit begins or ceases to act
  double sum_acceleration_change = 0.0, max_acceleration_change = 0.0;
  double worst_violation = 0.0;  ///< rad or m
  bool worst_is_angle = false;
  std::string worst_limit = "none";
  Times solver, cycle;  ///< time per rendering cycle

  /// Whether no event is missing, no fault occurred and every cycle was solved.
  bool is_well() const;
};

/// Plays the scenario once. The solver is timed on the problem of every cycle that renders, from
/// the active set of the cycle before.
LawRun play_law(const std::string& name, const config::Scenario& scenario);

}  // namespace hg::bench
