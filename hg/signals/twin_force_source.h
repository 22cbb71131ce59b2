/// What pushes the twin from outside the law, and what moves its base, asked once per period.
#pragma once

#include "hg/signals/frames.h"
#include "hg/signals/state.h"
#include "hg/signals/teleoperation.h"

namespace hg {

/// The twin where the next cycle begins, and what is known of hand and device from the last one.
struct TwinNow {
  const TwinState& twin;
  const Vector6& w_H;             ///< Wrench of the user on the handle, at H, resolved in B
  const ParameterChange& change;  ///< Of this cycle
  double time_s = 0.0;
  bool is_running = false;      ///< The law moves the twin
  bool is_clutch_open = false;  ///< The operator releases the remote machine
};

class TwinForceSource {
 public:
  virtual ~TwinForceSource() = default;
  /// Writes the force on the twin in the next cycle, and what is recorded of its origin. Called by
  /// the control thread: does not allocate, wait or throw.
  virtual void step(const TwinNow& now, TwinForce& force, TeleoperationReport& report) noexcept = 0;
};

/// What moves the root link of the twin.
class TwinBaseSource {
 public:
  virtual ~TwinBaseSource() = default;
  /// Motion for the cycle that begins now. Called by the control thread: does not allocate, wait or
  /// throw. `is_running`: the law moves the twin; `is_apart`: at standstill the twin cannot be
  /// where the handle is.
  virtual TwinBase step(bool is_running, bool is_apart) noexcept = 0;
};

}  // namespace hg
