/// Summary of a run: events, worst violations, forces, solver and timing, for people and scripts.
///
/// Fed with samples outside the control loop.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/analysis/events.h"
#include "hg/analysis/latency.h"
#include "hg/analysis/timing.h"
#include "hg/analysis/truth_summary.h"
#include "hg/signals/link_counts.h"
#include "hg/signals/state.h"

namespace hg::analysis {

/// Facts of a run that only the runtime has.
struct RunFacts {
  std::string scenario;
  std::string version;
  std::string law;      ///< law of the rendering
  std::string bounds;   ///< bounds of the limits
  std::string gantry;   ///< guidance of the gantry, "rule" or "law"
  std::string braking;  ///< braking before limits, "alone" or "together"
  std::string plant;    ///< what moves the simulated joints; empty = a machine, or one elsewhere
  std::string sensors;  ///< errors of the simulated sensors; empty likewise
  bool expects_events = false;  ///< the scenario has events in an order; else they are only seen
  double rate_Hz = 0.0;
  Timing timing;
  std::uint64_t dropped = 0;     ///< number of samples neither evaluated nor recorded
  std::uint64_t unrecorded = 0;  ///< number of samples evaluated but not recorded
  std::uint64_t allocations_in_loop = 0;
  std::string fault_figures;    ///< part, value and limit of the fault; empty = none
  bool stop_timed_out = false;  ///< drives were disabled while the device was moving
  LinkCounts link;  ///< counters of the link to a remote device; nothing sent = no remote device
  Latency latency;  ///< delays of link, drives, sensor and page, as far as known
  std::string recording;  ///< recording file; empty = off
  /// Reason why the recording ended before the run; empty = it did not
  std::string recording_error;
  double wall_time_s = 0.0;
};

/// Link counters as text: "12 sent, 11 received; 1 lost".
std::string link_text(const LinkCounts& counts);

class Summary {
 public:
  /// `positions` evaluates devices whose truth is known, as in TruthSummary.
  Summary(LimitCatalogue catalogue, FindPositions positions, double rate_Hz,
          const VectorM& torque_rated = {});

  void add(const Sample& sample);
  void add(const RunEvent& event) { events_.push_back(event); }

  /// No limit may be exceeded by the reference by more than 2 mm / 5 mrad ([HANDBOOK] 10.1), or in
  /// truth by more than 1 mm / 2 mrad.
  bool limits_held() const noexcept;
  /// Whether hand and device oscillated against each other during the run: FaultCode::kOscillation
  /// was warned of.
  bool has_shaken() const noexcept { return shaking_cycles_ > 0; }
  const std::vector<RunEvent>& events() const noexcept { return events_; }
  const Fault& fault() const noexcept { return fault_; }
  const TruthSummary& truth() const noexcept { return truth_; }
  double max_sync_error() const noexcept { return max_sync_error_; }

  /// The JSON of --summary. `missing` are expected events that did not happen.
  nlohmann::ordered_json to_json(const RunFacts& facts,
                                 const std::vector<std::string>& missing) const;
  /// The final lines of a run.
  std::string to_text(const RunFacts& facts, const std::vector<std::string>& missing) const;

 private:
  nlohmann::ordered_json truth_json() const;
  nlohmann::ordered_json solver_json() const;
  nlohmann::ordered_json shaking_json() const;
  nlohmann::ordered_json touch_json() const;
  std::string events_text(const RunFacts& facts, const std::vector<std::string>& missing) const;
  std::string truth_text() const;
  std::string limits_text() const;
  std::string hand_text() const;
  std::string solver_text() const;
  std::string losses_text(const RunFacts& facts) const;

  LimitCatalogue catalogue_;
  TruthSummary truth_;
  std::vector<RunEvent> events_;
  std::vector<double> worst_excess_;
  std::uint64_t cycles_ = 0, running_cycles_ = 0;
  double time_s_ = 0.0, duration_s_ = 0.0;  // of the last cycle; of the last that was running
  double max_sync_error_ = 0.0, max_sync_angle_ = 0.0;
  double sum_force_ = 0.0, max_force_ = 0.0, max_torque_ = 0.0;
  double rate_Hz_;
  std::uint64_t shaking_cycles_ = 0;
  double shaking_from_s_ = 0.0;
  bool feels_touch_ = false;  ///< contacts of the arm are monitored
  double max_touch_share_ = 0.0, touched_s_ = 0.0, max_touch_force_ = 0.0;
  Shaking shaking_ = Shaking::kNone;  ///< kind of oscillation at its begin
  std::array<std::uint64_t, 4> solver_status_{};
  std::uint64_t active_set_changes_ = 0;
  Histogram cycle_time_us_;
  Histogram acceleration_change_;
  double sum_acceleration_change_ = 0.0;
  Eigen::Vector3d last_acceleration_ = Eigen::Vector3d::Zero();
  std::uint64_t last_hash_ = 0;
  Fault fault_;
};

}  // namespace hg::analysis
