/// Benefit of inertial units on the links over encoders alone: errors of speeds and accelerations
/// against the truth of the simulation, with all units, with some, and when one fails.
///
/// The control does not use the units here: encoders and units see the same motion.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/workers.h"
#include "hg/signals/fault.h"

namespace hg::experiments {

/// Links that carry a unit, by name.
struct UnitSet {
  std::string name;
  std::vector<std::string> links;  ///< links, root to tip
  bool loses_one = false;          ///< the middle unit reads NaN from halfway on
};

/// Sets of units: one on each link that a different joint moves, and subsets. Without a gantry,
/// those of the arm.
std::vector<UnitSet> unit_sets(const config::DeviceConfig& device);

/// Frames of the links in the device's chain.
std::vector<int> frames_of(const config::DeviceConfig& device,
                           const std::vector<std::string>& links);

/// rms of an estimate minus the truth. Joints of the manipulator are taken together.
struct EstimateErrors {
  double joint_speed = 0.0;          ///< rad/s
  double joint_acceleration = 0.0;   ///< rad/s^2
  double gantry_acceleration = 0.0;  ///< m/s^2
  double handle_speed = 0.0;         ///< m/s
  double handle_acceleration = 0.0;  ///< m/s^2
};

struct InertialRun {
  std::string scenario, units;
  std::uint64_t seed = 0;
  /// Evaluated time, from the middle of the run on, s; 0 after a fault before it
  double judged_s = 0.0;
  /// Errors of the joint reference; its speeds are those of the encoders
  EstimateErrors reference;
  /// Errors of encoders alone; accelerations from differences of the speeds
  EstimateErrors encoders;
  EstimateErrors inertial;  ///< errors of encoders and units together
  double lateness = 0.0;    ///< delay of the units' contribution beyond the reference, s
  double trust = 0.0;       ///< lowest trust of a unit, at the end
  double bump = 0.0;        ///< largest change of a joint's acceleration in a period, rad/s^2
  FaultCode fault = FaultCode::kNone;
};

/// Plays a scenario with inertial units and stores the mounting they have learnt.
void learn_mounting(config::Scenario& scenario);

/// A scenario with a planned end, played twice: units learn their mounting, then they are
/// evaluated.
InertialRun play_with_units(const config::Scenario& scenario, const std::string& name,
                            const UnitSet& units, std::uint64_t seed);

/// Plays all sets with all scenarios and seeds 1..`seeds`, on all cores.
std::vector<InertialRun> measure_inertial(const std::vector<config::Scenario>& scenarios,
                                          const std::vector<std::string>& names, int seeds,
                                          const Progress& progress);

/// Results for python/hapticgiant/report/series.py.
nlohmann::ordered_json to_json(const std::vector<InertialRun>& runs);

}  // namespace hg::experiments
