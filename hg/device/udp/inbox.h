/// Filters the datagrams of one session: each good one is accepted once, in any order.
///
/// Pure: no socket, no clock. No allocation, noexcept.
#pragma once

#include <bitset>
#include <cstdint>

#include "hg/device/udp/codec.h"
#include "hg/device/udp/side.h"
#include "hg/signals/link_counts.h"

namespace hg::udp {

/// Window of seen numbers, like the replay window of IPsec (RFC 4303, 3.4.3).
class NumberWindow {
 public:
  static constexpr std::uint64_t kSize =
      512;  ///< window size: a number may be overtaken by so many
  enum class Place { kNewest, kOvertaken, kSeen };

  /// Classifies a number; one older than the window counts as seen.
  Place accept(std::uint64_t number) noexcept;
  /// Count of numbers since the first that have not been seen.
  std::uint64_t missing() const noexcept { return count_ == 0 ? 0 : newest_ - first_ + 1 - count_; }

 private:
  std::uint64_t first_ = 0, newest_ = 0, count_ = 0;
  std::bitset<kSize> seen_;  ///< bit i set: newest_ - i was seen
};

class Inbox {
 public:
  Inbox(std::uint32_t session, Side sender) : session_(session), sender_(sender) {}

  /// Counts a datagram by the verdict of read_header(); true: its fields are to be decoded. What
  /// the other side never sends is foreign and uses up no number: own datagrams may come back.
  bool accept(DatagramCheck verdict, const Header& header) noexcept;
  /// Whether the datagram accepted last was overtaken by a later one.
  bool was_overtaken() const noexcept { return was_overtaken_; }

  /// Link counts known to the inbox; users add their own.
  LinkCounts counts() const noexcept;

 private:
  std::uint32_t session_;
  Side sender_;
  NumberWindow window_;
  bool was_overtaken_ = false;
  LinkCounts counts_;
};

}  // namespace hg::udp
