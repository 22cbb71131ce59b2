/// One direction of a link between two machines, simulated: delay, jitter, loss, reordering and
/// outages.
///
/// The same seed and calls give the same packets. Fixed capacity; no allocation after construction.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/random.h"

namespace hg::teleoperation {

/// Set-up data of a channel.
struct ChannelConfig {
  double delay = 0.0;             ///< Least time on the way, s
  double jitter = 0.0;            ///< Largest further time, s; uniformly distributed
  double loss = 0.0;              ///< Share of packets that are lost, 0..1
  double burst = 0.0;             ///< Packets lost in a row, mean; 0 = each for itself
  bool keeps_order = false;       ///< A packet never overtakes another, as in TCP
  std::vector<Interval> outages;  ///< Times in which everything sent is lost, s
  std::uint64_t seed = 1;
};

/// Throws SetupError naming the field that is out of range.
void check_channel(const ChannelConfig& config);

template <typename Packet>
class Channel {
 public:
  /// `direction` makes the random numbers of two channels with one seed independent.
  Channel(const ChannelConfig& config, std::uint64_t direction, double dt)
      : config_(config), random_(2 * config.seed + direction) {
    check_channel(config);
    const double most = (config.delay + config.jitter) / dt + 8.0;
    packets_.resize(static_cast<std::size_t>(most));
    free_.reserve(packets_.size());
    for (std::size_t i = packets_.size(); i > 0; --i) free_.push_back(i - 1);
    due_.reserve(packets_.size());
  }

  void send(const Packet& packet, double now_s) noexcept {
    const bool is_lost = loses(now_s);
    double due_s = now_s + config_.delay + config_.jitter * random_.next();
    if (config_.keeps_order) due_s = std::max(due_s, last_due_s_);
    if (is_lost || free_.empty()) return;
    last_due_s_ = due_s;
    const std::size_t place = free_.back();
    free_.pop_back();
    packets_[place] = packet;
    due_.push_back({due_s, count_++, place});
    std::push_heap(due_.begin(), due_.end(), is_later);
  }

  /// Takes the packet that has arrived first; false: none has.
  bool receive(double now_s, Packet& packet) noexcept {
    constexpr double kRounding = 1e-9;  // s
    if (due_.empty() || due_.front().due_s > now_s + kRounding) return false;
    std::pop_heap(due_.begin(), due_.end(), is_later);
    packet = packets_[due_.back().place];
    free_.push_back(due_.back().place);
    due_.pop_back();
    return true;
  }

 private:
  struct Due {
    double due_s;
    std::uint64_t count;
    std::size_t place;
  };
  static bool is_later(const Due& a, const Due& b) noexcept {
    return a.due_s > b.due_s || (a.due_s == b.due_s && a.count > b.count);
  }

  // Two states after Gilbert: packets get lost in one of them.
  bool loses(double now_s) noexcept {
    const double leave = config_.burst > 0.0 ? 1.0 / config_.burst : 1.0 - config_.loss;
    const double enter =
        config_.loss < 1.0 ? std::min(1.0, leave * config_.loss / (1.0 - config_.loss)) : 1.0;
    const double draw = random_.next();
    is_losing_ = is_losing_ ? draw >= leave : draw < enter;
    return is_losing_ || std::ranges::any_of(config_.outages, [&](const Interval& outage) {
             return outage.contains(now_s);
           });
  }

  ChannelConfig config_;
  Random random_;
  bool is_losing_ = false;
  double last_due_s_ = 0.0;
  std::uint64_t count_ = 0;
  std::vector<Packet> packets_;
  std::vector<std::size_t> free_;
  std::vector<Due> due_;  ///< Heap, the earliest first
};

}  // namespace hg::teleoperation
