/// What a run was like: events, worst violations, forces, solver and timing, for people and
/// scripts.
///
/// Fed with samples outside the control loop.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hg/evaluation/events.h"
#include "hg/signals/state.h"

namespace hg::evaluation {

/// Median, 99.9th percentile and maximum of a quantity.
struct Distribution {
  double median = 0.0, p99_9 = 0.0, max = 0.0;
};

/// Of `values`, which are reordered; zeros when there are none.
Distribution distribution(std::vector<float>& values);

/// What the runtime alone knows.
struct RunFacts {
  std::string scenario;
  std::string version;
  double rate_Hz = 0.0;
  bool is_fast = false;
  std::uint64_t overruns = 0;
  std::uint64_t dropped = 0;
  std::uint64_t allocations_in_loop = 0;
  std::string recording;  ///< file, empty when off
  double wall_time_s = 0.0;
};

class Summary {
 public:
  explicit Summary(LimitCatalogue catalogue);

  void add(const Sample& sample);
  void add(const Event& event) { events_.push_back(event); }

  /// [HANDBOOK] 10.1: no limit may be exceeded by more than 2 mm / 5 mrad.
  bool limits_held() const noexcept;
  const std::vector<Event>& events() const noexcept { return events_; }
  const Fault& fault() const noexcept { return fault_; }
  double max_sync_error() const noexcept { return max_sync_error_; }

  /// The JSON text of --summary. `missing` are expected events that did not happen.
  std::string to_json(const RunFacts& facts, const std::vector<std::string>& missing);
  /// The closing lines of a run.
  std::string to_text(const RunFacts& facts, const std::vector<std::string>& missing);

 private:
  LimitCatalogue catalogue_;
  std::vector<Event> events_;
  std::vector<double> worst_excess_;
  std::uint64_t cycles_ = 0, running_cycles_ = 0;
  double duration_s_ = 0.0;
  double max_sync_error_ = 0.0, max_sync_angle_ = 0.0;
  double sum_force_ = 0.0, max_force_ = 0.0, max_torque_ = 0.0;
  std::array<std::uint64_t, 4> solver_status_{};
  std::uint64_t active_set_changes_ = 0;
  std::vector<float> cycle_time_us_;
  std::vector<float> acceleration_change_;
  double sum_acceleration_change_ = 0.0;
  Eigen::Vector3d last_acceleration_ = Eigen::Vector3d::Zero();
  Fault fault_;
};

}  // namespace hg::evaluation
