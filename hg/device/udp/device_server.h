/// Serves a device to one client at a time: the other side of docs/reference/device_protocol.md.
///
/// Single-threaded. Real time: the device advances by this server's clock, with the newest command.
/// Lock-step: it advances by a period when the command that answers its last frame has arrived.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "hg/device/device.h"
#include "hg/device/udp/address.h"
#include "hg/device/udp/key.h"
#include "hg/device/udp/protocol.h"
#include "hg/signals/link_counts.h"

namespace hg::udp {

/// Set-up data of a device server.
struct ServerConfig {
  Description actual;
  std::string server;         ///< program and version, reported to the client
  bool is_simulated = false;  ///< simulated device: its brakes need no test
  /// Real time: drives off after this time without a good command; a command that answers an older
  /// frame does not count.
  double command_timeout_s = 0.05;
  double lock_step_timeout_s = 5.0;
  /// Time between welcome and ready, in which the client sets itself up
  double ready_timeout_s = 30.0;
  std::string capture;  ///< file that receives every datagram, see Capture; empty = none
  Key key;              ///< shared key, which clients must have, too
};

enum class SessionEnd {
  kClientLeft,
  kClientSilent,  ///< no good command within the time-out
  kStopped,       ///< stopped by the caller
};

/// Summary of a session.
struct SessionReport {
  SessionEnd end = SessionEnd::kStopped;
  std::string client;         ///< name and address, printable
  std::string farewell;       ///< farewell text of the client, printable
  std::string other;          ///< address of the first other sender into this session; empty = none
  std::uint64_t periods = 0;  ///< periods for which the device advanced
  std::uint64_t overruns = 0;
  /// Time from a frame to the command that answers it
  double mean_answer_s = 0.0, max_answer_s = 0.0;
  LinkCounts link;
};

class Server;

class DeviceServer {
 public:
  /// Throws SetupError.
  DeviceServer(const Address& address, const ServerConfig& config);
  ~DeviceServer();

  /// Listening address HOST:PORT, with the port that the system chose for 0.
  std::string address() const;

  /// Why the capture misses datagrams; empty: it is complete, or there is none.
  std::string capture_error();

  /// Blocks until a client has been welcomed and is ready. False: stopped by `stop`.
  bool wait_for_client(const std::atomic<bool>& stop);
  /// Runs the session of this client. However it ends, the last command disables the drives.
  SessionReport serve(device::Device& device, const std::atomic<bool>& stop);

 private:
  std::unique_ptr<Server> server_;
};

}  // namespace hg::udp
