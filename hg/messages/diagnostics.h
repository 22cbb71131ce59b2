/// State of a run as a diagnostic message: mode, fault, late cycles and the limits that act.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/messages/ros_messages.h"
#include "hg/messages/run_names.h"
#include "hg/signals/state.h"

namespace hg::messages {

class Diagnostics {
 public:
  explicit Diagnostics(const RunNames& names);

  /// Counts late cycles; takes every sample, in order.
  void observe(const Sample& sample);
  /// Whether mode, fault or the set of acting limits differ from the last message, or that is
  /// kPeriod_s old.
  bool is_due(const CycleRecord& record) const;
  /// The message of this moment.
  const DiagnosticArray& update(const Sample& sample, std::uint64_t time_ns);

  static constexpr double kPeriod_s = 0.5;  ///< in time of the run

 private:
  DiagnosticStatus device_status(const Sample& sample) const;
  DiagnosticStatus loop_status() const;
  DiagnosticStatus limit_status(const CycleRecord& record) const;

  LimitCatalogue limits_;
  std::uint64_t late_cycles_ = 0;
  double longest_cycle_us_ = 0.0;  ///< since the last message
  bool has_message_ = false;
  double time_s_ = 0.0;  ///< of the last message
  Mode mode_ = Mode::kOff;
  FaultCode fault_ = FaultCode::kNone;
  std::vector<bool> is_acting_;  ///< limits in the last message
  DiagnosticArray message_;
};

}  // namespace hg::messages
