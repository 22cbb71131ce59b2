/// Random operation of a remote arm whose model is the twin: whether it ever stops, and
/// whether its ends are felt where they are.
///
/// Judged by what the simulation of the arm knows, not by what it reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/workers.h"

namespace hg::experiments {

struct RemoteOperation {
  double duration_s = 30.0;  ///< of the strokes of a run
  double force = 40.0;       ///< largest pull of a hand, N
};

/// What happened in a run, or in several.
struct RemoteOperationFigures {
  double engaged_s = 0.0;          ///< time in which both sides were coupled
  int stops = 0;                   ///< times that the arm held, also by a protective stop
  int faults = 0;                  ///< runs that a fault of the device ended
  std::vector<std::string> notes;  ///< what these were, in words
  int ends = 0;                    ///< times that a hand pressed an end of the twin, at rest
  double felt_early = 0.0;         ///< largest way of the tool from there to the arm's end, m
  double felt_late = 0.0;          ///< the same beyond it, m
  double arm_beyond = 0.0;         ///< largest way of the arm's joint beyond its end, rad
  double arm_speed = 0.0;          ///< largest speed of a joint of the arm, rad/s
  double held_back_s = 0.0;        ///< time in which the arm's limits held it back
  double largest_lag = 0.0;        ///< of the arm behind the twin, rad

  void add(const RemoteOperationFigures& other);
};

/// Whether nothing stopped, and all ends were felt within 2 mm of where they are.
bool is_good(const RemoteOperationFigures& figures) noexcept;

/// Plays the scenario with random hands of the seeds first .. first + count - 1, on all cores. Its
/// teleoperation must lead joints. Throws SetupError.
std::vector<RemoteOperationFigures> operate_at_random(const config::Scenario& scenario,
                                                      const RemoteOperation& operation,
                                                      std::uint64_t first, int count,
                                                      const Progress& progress);

}  // namespace hg::experiments
