/// Recognises the events of a run: an ordered list of events, each a conjunction of conditions on
/// one CycleRecord. Works on records only, outside the control loop.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/signals/state.h"

namespace hg::evaluation {

enum class ConditionKind {
  kLimit,        ///< limit `index` is felt on `side` within 2 mm / 5 mrad of it
  kSpeedLimit,   ///< the velocity rating of limit `index` acts
  kLocked,       ///< a lock holds limit `index`
  kForceAbove,   ///< norm of the user's force > value, N
  kForceBelow,   ///< norm of the user's force < value, N
  kTwinAbove,    ///< twin coordinate `index` > value
  kTwinBelow,    ///< twin coordinate `index` < value
  kTurns,        ///< manipulator joint `index` has turned by `value` turns since the start
  kGantryAbove,  ///< gantry joint `index` > value, m
  kGantryBelow,  ///< gantry joint `index` < value, m
  kElapsed,      ///< time since the first running cycle > value, s
  kHandleAt,     ///< the handle is nearer than 0.10 m and 15 degrees to `place`
};

struct Condition {
  ConditionKind kind = ConditionKind::kElapsed;
  int index = 0;
  LimitState side = LimitState::kInactive;  ///< side of the limit; kInactive = either side
  double value = 0.0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< place of the handle in B: x, y, azimuth
};

struct EventRule {
  std::string name;               ///< name, e.g. "t_a", "locked"
  std::string what;               ///< description in one sentence
  std::vector<Condition> all_of;  ///< conditions that must hold together
};

struct Event {
  std::string name;
  double time_s = 0.0;
  std::string what;
};

/// Detects events in the order of their rules: each is looked for once the one before it has
/// happened.
class EventDetector {
 public:
  /// State of a limited quantity, for the events of a run without rules.
  enum class Situation { kFree, kAtLower, kAtUpper, kLocked };

  /// With no rules, every limit that begins to act and every lock that opens or closes is an event.
  EventDetector(std::vector<EventRule> rules, LimitCatalogue catalogue);

  /// The event that this record completes, if any.
  std::optional<Event> observe(const CycleRecord& record);

  /// Names of the rules that have not happened yet.
  std::vector<std::string> missing() const;

 private:
  std::optional<Event> observe_limits(const CycleRecord& record);
  bool holds(const Condition& condition, const CycleRecord& record) const;

  std::vector<EventRule> rules_;
  LimitCatalogue catalogue_;
  std::size_t next_ = 0;
  VectorM q_m_start_;  ///< joint positions in the first running cycle
  double start_s_ = 0.0;
  std::vector<Situation> situations_;  ///< situation of every limit in the last record
};

}  // namespace hg::evaluation
