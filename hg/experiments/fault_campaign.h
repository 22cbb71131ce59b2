/// Faults on purpose in many runs: is each one noticed, how soon, what does the machine do, and
/// what does the person at the handle get to feel. Source: [HANDBOOK] 6.2.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/scenario.h"
#include "hg/experiments/workers.h"
#include "hg/injection/injection.h"
#include "hg/recording/recorder.h"
#include "hg/signals/truth.h"

namespace hg::experiments {

struct CampaignConfig {
  int cases = 560;
  std::uint64_t seed = 1;
  double watched_s = 2.0;  ///< after a fault begins
  /// A run without a reaction is harmless while the truth stays within these.
  double harmless_excess = 0.01;  ///< outside any limit of the device, rad or m
  double harmless_force = 50.0;  ///< more than without the fault, N: what the device gives for long
  double harmless_distance = 0.02;  ///< of true handle and twin, m
  /// No run, with or without a reaction, may go beyond these, nor any axis beyond its stopping
  /// distance.
  double excess_bound = 0.10;  ///< outside any limit of the device, rad or m
  double force_bound = 280.0;  ///< on the person; twice what a hand bears at rest, N
  double energy_bound = 30.0;  ///< given to the person during the stop, J
};

enum class Outcome : std::uint8_t {
  kNoticed = 0,    ///< the device stopped
  kHarmless = 1,   ///< it went on, and nothing became worse
  kUnnoticed = 2,  ///< it went on, and something became worse
};

/// When the faults of a case begin.
enum class Phase : std::uint8_t {
  kRunning = 0,   ///< one, while the device runs
  kPair = 1,      ///< two, of which the second begins up to half a second after the first
  kStopping = 2,  ///< one, during a stop that somebody has asked for by an emergency stop
  kStarting = 3,  ///< one, from before the device is tared and armed
};

/// What became of one fault, or of a pair of them.
struct FaultCase {
  std::size_t scenario = 0;  ///< index
  Phase phase = Phase::kRunning;
  injection::Injection injection;
  std::optional<injection::Injection> other;  ///< that was played besides
  Outcome outcome = Outcome::kHarmless;
  FaultCode fault = FaultCode::kNone;  ///< that was noticed; a released switch is none
  Stop stop = Stop::kNone;
  double noticed_s = 0.0;  ///< after it began
  double stopped_s =
      0.0;  ///< after it was noticed, until its drives stood still; NaN: they did not
  double peak_force = 0.0;      ///< of the person, true, from the begin of the fault on, N
  double worst_excess = 0.0;    ///< true, outside any limit of the device, rad or m
  double worst_distance = 0.0;  ///< of true handle and twin while running or stopping, m
  /// Largest way of an axis that nobody asked for, true: off its plan until the device stopped, and
  /// all of it from there on; as a share of its stopping distance.
  double travel_share = 0.0;
  double energy = 0.0;           ///< given to the person from the stop on, J
  bool is_told_to_fall = false;  ///< rule 323 has said that a brake does not hold
  bool is_complete = true;       ///< its recording has every cycle, in order, once
};

struct Campaign {
  CampaignConfig config;
  std::vector<std::string> scenarios;
  std::vector<FaultCase> cases;
};

/// Whether the drives stand still: a person who pulls goes on to bend the springs behind them.
bool stands_still(const Truth& truth);

/// When faults begin: the hand has settled, and the script goes on for a while. Empty (lb > ub) for
/// a script that is too short, or that there is none.
Interval fault_times(const config::Scenario& scenario);

/// One run with the faults of `drawn`, whose other fields say what became of it. `scenario` has a
/// script; `clean_force` is the person's peak without the fault. The run is recorded as `recording`
/// says, read back and deleted; null: it is not.
FaultCase play_fault(const config::Scenario& scenario, FaultCase drawn,
                     const CampaignConfig& config, double clean_force,
                     const recording::RecordingInfo* recording = nullptr);

/// All kinds in turn, each in all phases in turn, in random scenarios, at random times, of random
/// sizes; on all cores. The
/// scenarios are played on their own simulated machines. `recordings` are what the recording of
/// each scenario is told, with a folder that is deleted afterwards; empty: nothing is recorded.
Campaign run_campaign(const std::vector<config::Scenario>& scenarios, const CampaignConfig& config,
                      const std::vector<recording::RecordingInfo>& recordings,
                      const Progress& progress);

/// Whether no fault was unnoticed and no bound exceeded.
bool is_passed(const Campaign& campaign);
/// A row per kind of fault, and what went wrong.
std::string to_text(const Campaign& campaign);
/// The same table and its last line, as a page.
std::string to_markdown(const Campaign& campaign);
nlohmann::ordered_json to_json(const Campaign& campaign);

}  // namespace hg::experiments
