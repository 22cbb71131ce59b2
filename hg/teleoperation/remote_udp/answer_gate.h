/// Decides which packets of a remote machine the leader's half gets: it trusts no machine.
///
/// A packet that lies is replaced by the last good one, with the cause why the machine must count
/// as holding: the force then fades until the clutch has been used.
///
/// Pure: no socket, no clock. No allocation, noexcept.
#pragma once

#include "hg/signals/remote_packets.h"

namespace hg::teleoperation {

class AnswerGate {
 public:
  /// Of a machine with `size` coordinates.
  explicit AnswerGate(Eigen::Index size) noexcept : size_(size) {}

  /// Looks at an arrived packet. True: `passed` is for the leader.
  bool take(const RemotePacket& packet, double now_s, RemotePacket& passed) noexcept;
  /// The same once per period: packets that keep coming without use are named, once.
  bool check(double now_s, RemotePacket& passed) noexcept;
  /// Another session with the machine has begun: what was engaged is not any more.
  bool begin_again(RemotePacket& passed) noexcept;

 private:
  bool has_jumped(const RemotePacket& packet) const noexcept;
  bool pass_as(RemoteCause cause, RemotePacket& passed) const noexcept;

  Eigen::Index size_;
  RemotePacket good_;           ///< Newest that was passed as it came
  std::uint64_t sequence_ = 0;  ///< Newest that came
  double sent_s_ = 0.0;         ///< Of that
  double used_s_ = 0.0;         ///< When the newest good one came
  int repeated_ = 0, frozen_ = 0;
};

}  // namespace hg::teleoperation
