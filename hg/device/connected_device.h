/// A device at the other end of a connection, which is the clock of a run.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "hg/device/device.h"
#include "hg/signals/link_counts.h"

namespace hg::device {

class ConnectedDevice : public Device {
 public:
  bool is_clock() const noexcept override { return true; }
  /// Ends the connection and says why: kNone = as planned. May block for a bounded time. Only once.
  virtual void close(FaultCode reason) noexcept = 0;
  /// What the device said when it ended or refused to move, printable; empty: nothing.
  virtual std::string farewell() const = 0;
  virtual LinkCounts counts() const noexcept = 0;
  /// How late this computer was in the last read(), ns: from when its sample could have been read,
  /// because it had arrived or its period was due, to its return. A sample that comes late from the
  /// device adds nothing.
  virtual std::int64_t late_ns() const noexcept = 0;
  /// Time from a sample to the arrival of its command at the device, as the device measures it, s;
  /// NaN: it has not said so. From any thread.
  virtual double round_trip_s() const noexcept { return std::numeric_limits<double>::quiet_NaN(); }
};

}  // namespace hg::device
