/// A device at the other end of a network: the client of docs/reference/device_protocol.md.
///
/// Set-up (constructor, close()) may block and throw; read() and write() follow the contract of
/// Device, but read() waits for the next frame: the device is the clock.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hg/device/connected_device.h"
#include "hg/device/udp/address.h"
#include "hg/device/udp/key.h"
#include "hg/device/udp/protocol.h"

namespace hg::udp {

/// Set-up data of a remote device.
struct ClientConfig {
  Description expected;           ///< expected description; any other is refused
  std::string client;             ///< program and version, for the server's log
  double answer_timeout_s = 3.0;  ///< time-out for the welcome
  double busy_patience_s = 0.0;   ///< time to keep asking a device that has another client
  double first_timeout_s = 1.0;   ///< time-out for the first frame
  /// Time-out between frames. In real time it is limited by the possible travel of a gantry at 1.5
  /// m/s (75 mm), in lock-step by the patience with a slow simulator.
  double frame_timeout_s = 0.05;
  double lock_step_timeout_s = 5.0;
  Key key;  ///< shared key, which the server must have, too
};

class Client;

class RemoteDevice final : public device::ConnectedDevice {
 public:
  /// Connects. Throws SetupError: no answer, refused and why, other device or version.
  RemoteDevice(const Address& address, const ClientConfig& config);
  ~RemoteDevice() override;

  /// Waits for the next frame, at most one of the time-outs. After a time-out or a goodbye of the
  /// server, the last frame is repeated with its driver_fault set, from now on without waiting.
  void read(SensorFrame& sensors) noexcept override;
  void write(const CommandFrame& command) noexcept override;

  /// Notifies the server that the session is over, without waiting.
  void close(FaultCode reason) noexcept override;

  const Welcome& welcome() const noexcept;
  /// Reason why the server ended the session, printable; empty: it did not.
  std::string farewell() const override;
  LinkCounts counts() const noexcept override;
  std::int64_t late_ns() const noexcept override;
  double round_trip_s() const noexcept override;

 private:
  std::unique_ptr<Client> client_;
};

}  // namespace hg::udp
