/// The boundary between controller and machine. The controller cannot tell drivers apart.
#pragma once

#include "hg/signals/frames.h"

namespace hg::device {

/// One call of read() and one of write() per period, from the control thread only. Neither
/// allocates, blocks or throws.
class Device {
 public:
  virtual ~Device() = default;
  virtual void read(SensorFrame& sensors) noexcept = 0;
  virtual void write(const CommandFrame& command) noexcept = 0;
};

}  // namespace hg::device
