/// Rules that recognise the events of a run: each is a conjunction of conditions on one
/// CycleRecord.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/signals/limit.h"

namespace hg {

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
  kSurface,      ///< virtual surface `index` pushes the twin most
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

}  // namespace hg
