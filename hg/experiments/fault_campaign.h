/// Injected faults in many runs: detection and its delay, reaction of the machine, and what the
/// person at the handle feels. Source: [HANDBOOK] 6.2.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/recording/recorder.h"
#include "hg/signals/truth.h"
#include "hg/simulator/faults/injection.h"

namespace hg::experiments {

class Runs;

struct CampaignConfig {
  int cases = 560;
  std::uint64_t seed = 1;
  double watched_s = 2.0;  ///< time observed after a fault begins, s
  /// Time within which the drift of a gantry encoder is to be noticed after that, s: 10 mm/s pass
  /// `monitor.gantry_drift_m` after 6 s, and 0.5 % of the axis' way.
  double patience_s = 10.0;
  /// Bounds on the true state within which a run without a reaction is harmless.
  double harmless_excess = 0.01;  ///< excess over any limit of the device, rad or m
  /// Force above that without the fault, N: the device's continuous force
  double harmless_force = 50.0;
  double harmless_distance = 0.02;  ///< distance of true handle and twin, m
  /// Bounds for every run, with or without a reaction; no axis may exceed its stopping distance
  /// either.
  double excess_bound = 0.10;  ///< outside any limit of the device, rad or m
  double force_bound = 280.0;  ///< force on the person, N: twice what a hand bears at rest
  double energy_bound = 30.0;  ///< energy given to the person during the stop, J
};

enum class Outcome : std::uint8_t {
  kNoticed = 0,    ///< the device stopped
  kHarmless = 1,   ///< the device continued, and nothing became worse
  kUnnoticed = 2,  ///< the device continued, and something became worse
};

/// Time at which the faults of a case begin.
enum class Phase : std::uint8_t {
  kRunning = 0,   ///< one fault, while the device runs
  kPair = 1,      ///< two faults, the second up to half a second after the first
  kStopping = 2,  ///< one fault, during a requested emergency stop
  kStarting = 3,  ///< one fault, from before the device is tared and armed
};

/// Result of one fault, or of a pair.
struct FaultCase {
  std::size_t scenario = 0;  ///< index of the scenario
  Phase phase = Phase::kRunning;
  faults::Injection injection;
  std::optional<faults::Injection> other;  ///< second fault of a pair, or the stop
  Outcome outcome = Outcome::kHarmless;
  FaultCode fault = FaultCode::kNone;  ///< detected fault; a released switch is none
  Stop stop = Stop::kNone;
  double noticed_s = 0.0;  ///< time from the begin of the fault to its detection, s
  double stopped_s =
      0.0;  ///< time from detection until the drives stood still, s; NaN = they did not
  double peak_force = 0.0;  ///< largest true force of the person from the begin of the fault on, N
  double worst_excess = 0.0;  ///< largest true excess over any limit of the device, rad or m
  /// Largest distance of true handle and twin while running or stopping, m
  double worst_distance = 0.0;
  /// Largest true unplanned travel of an axis: deviation from its plan until the device stopped,
  /// all travel from there on; as a share of its stopping distance.
  double travel_share = 0.0;
  double energy = 0.0;             ///< energy given to the person from the stop on, J
  bool has_reported_slip = false;  ///< rule 323 has reported that a brake does not hold
  bool has_run = false;            ///< the device was running with the fault
  bool is_complete = true;         ///< the recording has every cycle exactly once, in order
};

struct Campaign {
  CampaignConfig config;
  std::vector<std::string> scenarios;
  std::vector<FaultCase> cases;
  /// Kinds that none of the devices can have, with the reason
  std::vector<std::pair<const faults::Kind*, std::string>> impossible;
};

/// Why a device with these sensors and commands cannot have a fault of this kind; empty = it can.
std::string why_impossible(const faults::Kind& kind, const SensorFrame& sensors,
                           const CommandFrame& command);

/// Range of times at which faults begin: the hand has settled, and the script continues for a
/// while. Empty (lb > ub) if the script is too short or missing.
Interval fault_times(const config::Scenario& scenario);

/// Plays one run with the faults of `drawn` and returns it with its result filled in, not yet
/// judged. `scenario` has a script. The run is recorded as `recording` says, read back and deleted;
/// null = not recorded.
FaultCase play_fault(const config::Scenario& scenario, const FaultCase& drawn,
                     const CampaignConfig& config,
                     const recording::RecordingInfo* recording = nullptr);

/// Whether a run without a reaction was harmless. `clean_force` is the person's peak without the
/// fault, N.
void judge(const CampaignConfig& config, double clean_force, FaultCase& result);

/// Plays all kinds in turn, each in all phases in turn, in random scenarios, at random times, of
/// random sizes. The scenarios are played on their own simulated machines.
/// `recordings` holds the recording information of each scenario, with a folder that is deleted
/// afterwards; empty = no recording.
Campaign run_campaign(const std::vector<config::Scenario>& scenarios, const CampaignConfig& config,
                      const std::vector<recording::RecordingInfo>& recordings, Runs& runs);

/// All cases, the bounds, and all kinds of faults; python/hapticgiant/report/faults.py judges them.
nlohmann::ordered_json to_json(const Campaign& campaign);

}  // namespace hg::experiments
