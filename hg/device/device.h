/// Interface between controller and machine. The controller cannot distinguish drivers.
#pragma once

#include "hg/signals/frames.h"
#include "hg/signals/truth.h"

namespace hg::device {

/// A real or simulated machine. One call of read() and one of write() per period, from the control
/// thread only. Neither allocates or throws, and only the read() of a device that is the clock
/// blocks.
class Device {
 public:
  virtual ~Device() = default;
  /// Reads the sensors of one sample. Needed: `sequence` (one more than in the last sample) and
  /// `time_s`; `q_m`, `dq_m` and `q_p` with one value per joint or axis (no axes: empty); `w_S`;
  /// `dead_man`, unless the tool has none; and with torque control (control.method modal or
  /// motor_pd) `theta_m`, `tau_m` and `answered_sequence`. The rest may stay as it is. A sample
  /// with too few or too many values is refused with FaultCode::kSensorIncomplete.
  virtual void read(SensorFrame& sensors) noexcept = 0;
  /// Sends the command until the next sample.
  virtual void write(const CommandFrame& command) noexcept = 0;
  /// Ground truth at the last read(); null: unknown, the device is real.
  virtual const Truth* truth() const noexcept { return nullptr; }
  /// Whether read() waits for the next sample (for a bounded time) and so clocks the loop.
  virtual bool is_clock() const noexcept { return false; }
};

}  // namespace hg::device
