/// The boundary between controller and machine. The controller cannot tell drivers apart.
#pragma once

#include "hg/signals/frames.h"
#include "hg/signals/truth.h"

namespace hg::device {

/// One call of read() and one of write() per period, from the control thread only. Neither
/// allocates or throws, and only the read() of a device that is the clock blocks.
class Device {
 public:
  virtual ~Device() = default;
  virtual void read(SensorFrame& sensors) noexcept = 0;
  virtual void write(const CommandFrame& command) noexcept = 0;
  /// What is really the case at the last read(); null where nobody knows: the device is real.
  virtual const Truth* truth() const noexcept { return nullptr; }
  /// Faults on purpose of the computer that runs the cycle, after read(); only simulated devices
  /// have some.
  virtual void spoil(OperatorFrame& /*input*/) const noexcept {}
  /// Whether read() waits for the next sample, at most a fixed time: then nobody else keeps time.
  virtual bool is_clock() const noexcept { return false; }
};

}  // namespace hg::device
