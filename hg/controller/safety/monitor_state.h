/// State of the monitor from cycle to cycle.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "hg/controller/safety/rules.h"
#include "hg/controller/safety/shaking.h"
#include "hg/core/types.h"

namespace hg::safety {

/// Part of the copyable state of a cycle.
struct MonitorState {
  /// Consecutive samples in which each rule was broken.
  std::array<std::uint16_t, kRuleCount> broken{};
  bool is_broken = false;   ///< A rule was broken in the last cycle
  bool has_sample = false;  ///< The values below hold the last sample
  VectorM q_m, tau_m;
  VectorP q_p;
  Vector6 w_S = Vector6::Zero(), imu = Vector6::Zero();
  double time_s = 0.0;
  /// Consecutive samples with the same bits: joint torques, wrench and inertial unit.
  std::array<std::uint16_t, kMaxManipulator + 12> same{};
  double clock_error = 0.0;  ///< Mean error of the clock, periods per sample
  double late = 0.0;         ///< Late cycles minus those allowed since, >= 0
  int late_in_a_row = 0;
  VectorP dq_p_model;       ///< Gantry velocity by its drive model, m/s or rad/s
  VectorP gantry_gap;       ///< Gantry position off the drive model; fast forgetting
  VectorP gantry_drift;     ///< Gantry position off the drive model; slow forgetting
  VectorP gantry_way;       ///< Distance travelled by the model; slow forgetting
  VectorM pulled_back;      ///< Sum of the reference's shifts; forgotten after the last
  VectorM momentum;         ///< Motor momentum predicted from commands and springs, Nms
  VectorM lowest, highest;  ///< Allowed joint range: limits, extended to the position when armed
  VectorP lowest_p, highest_p;
  bool is_stopping = false;         ///< The values below belong to the present stop
  VectorM stop_from, braking_ramp;  ///< Joints: position at the start, position of the ramp
  VectorM ramp_speed;  ///< Joint speeds by the accelerations of the reference since the stop began
  /// Gantry: position at the start, position by the drive model.
  VectorP stop_from_p, braking_ramp_p;
  ShakingState shaking;
};

/// Words of the state hash, in its order. Without the rules that are younger than 0.2.0, of which
/// the monitor looks at one only: hashes of runs recorded before stay what they were.
void hashed(auto& hash, const MonitorState& state) {
  const auto& [broken, is_broken, has_sample, q_m, tau_m, q_p, w_S, imu, time_s, same, clock_error,
               late, late_in_a_row, dq_p_model, gantry_gap, gantry_drift, gantry_way, pulled_back,
               momentum, lowest, highest, lowest_p, highest_p, is_stopping, stop_from, braking_ramp,
               ramp_speed, stop_from_p, braking_ramp_p, shaking] = state;
  constexpr std::size_t kYounger = rule_index(FaultCode::kTwinForceWrong);
  constexpr std::size_t kOlder = rule_index(FaultCode::kLimitNotHeld) - 1;
  std::array<std::uint16_t, kOlder> older{};
  std::copy_n(broken.begin(), kYounger, older.begin());
  std::copy_n(broken.begin() + kYounger + 1, kOlder - kYounger, older.begin() + kYounger);
  hash.mix_first(older, static_cast<int>(kOlder));
  hash.mix(same,
           static_cast<std::uint64_t>(late_in_a_row) | std::uint64_t{has_sample} << 62U |
               std::uint64_t{is_broken} << 63U,
           time_s, clock_error, late, w_S, imu, q_m, tau_m, pulled_back, momentum, lowest, highest,
           q_p, dq_p_model, gantry_gap, gantry_drift, gantry_way, lowest_p, highest_p, stop_from_p,
           braking_ramp_p, is_stopping, stop_from, braking_ramp, ramp_speed);
}

}  // namespace hg::safety
