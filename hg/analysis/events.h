/// Recognises the events of a run: an ordered list of events, each a conjunction of conditions on
/// one CycleRecord. Works on records only, outside the control loop.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/signals/event_rule.h"
#include "hg/signals/state.h"

namespace hg::analysis {

struct RunEvent {
  std::string name;
  double time_s = 0.0;
  std::string what;
};

/// Detects events in the order of their rules: each is expected after the one before it has
/// happened.
class EventDetector {
 public:
  /// State of a limited quantity, for the events of a run without rules.
  enum class Situation { kFree, kAtLower, kAtUpper, kLocked };

  /// With no rules, every limit that begins to act and every lock that opens or closes is an event.
  EventDetector(std::vector<EventRule> rules, LimitCatalogue catalogue);

  /// The event that this record completes, if any.
  std::optional<RunEvent> observe(const CycleRecord& record);

  /// Names of the rules that have not happened yet.
  std::vector<std::string> missing() const;

 private:
  std::optional<RunEvent> observe_limits(const CycleRecord& record);
  bool holds(const Condition& condition, const CycleRecord& record) const;

  std::vector<EventRule> rules_;
  LimitCatalogue catalogue_;
  std::size_t next_ = 0;
  VectorM q_m_start_;  ///< joint positions in the first running cycle
  double start_s_ = 0.0;
  std::vector<Situation> situations_;  ///< situation of every limit in the last record
};

}  // namespace hg::analysis
