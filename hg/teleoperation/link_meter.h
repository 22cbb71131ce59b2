/// What one side measures of the packets of the other: round trip, jitter, loss.
///
/// Differences of one clock only, so that both sides may have clocks of their own. No allocation,
/// noexcept.
#pragma once

#include <cstdint>

namespace hg::teleoperation {

class LinkMeter {
 public:
  /// Looks at an arrived packet, in any order. `sent_s`: by the sender's clock; `answered_s`: when
  /// the newest of our own packets was sent that the sender had in use, by our clock; 0 = none.
  void receive(std::uint64_t sequence, double sent_s, double answered_s, double now_s) noexcept;
  /// Once per period.
  void step(double now_s) noexcept;

  double round_trip() const noexcept { return round_trip_; }
  /// Mean difference of the delays of two packets in a row, as in RFC 3550.
  double jitter() const noexcept { return jitter_; }
  /// Share of the packets of the last second that have not arrived, 0..1.
  double loss() const noexcept { return loss_; }

 private:
  double round_trip_ = 0.0, jitter_ = 0.0, loss_ = 0.0;  ///< Round trip and jitter in s
  double way_ = 0.0;           ///< Of the packet before, by both clocks, s
  bool has_way_ = false;       ///< There was one
  double window_s_ = 0.0;      ///< When the present second began
  bool has_window_ = false;    ///< It has begun
  std::uint64_t newest_ = 0;   ///< Largest sequence number
  std::uint64_t before_ = 0;   ///< The same when the second began
  std::uint64_t arrived_ = 0;  ///< In this second
};

}  // namespace hg::teleoperation
