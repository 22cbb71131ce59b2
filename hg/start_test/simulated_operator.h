/// Operator of a simulated device in its test: performs requested actions by the panel and the hand
/// target of a command, which real machines ignore.
#pragma once

#include "hg/core/types.h"
#include "hg/signals/frames.h"
#include "hg/start_test/procedure.h"

namespace hg::start_test {

class SimulatedOperator {
 public:
  /// Requests an action, performed a little later.
  void prompt(Act act) noexcept;
  /// Writes the present action into the command of this period; `T_B_H` is the handle.
  void operate(double time_s, const Pose& T_B_H, CommandFrame& command) noexcept;

 private:
  void begin(Act act) noexcept;
  HandTarget lean(double for_s) const noexcept;

  SafetyPanel panel_;
  Act act_ = Act::kNone, next_ = Act::kNone;
  double next_s_ = 0.0, since_s_ = 0.0;
  bool is_asked_ = false, has_seen_ = false;
  Pose start_;  ///< initial handle pose: the hand rests there
};

}  // namespace hg::start_test
