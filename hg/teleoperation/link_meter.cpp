#include "hg/teleoperation/link_meter.h"

#include <algorithm>
#include <cmath>

namespace hg::teleoperation {
namespace {

constexpr double kWindow = 1.0;          // s, in which packets are counted
constexpr double kShare = 1.0 / 16.0;    // of a packet in the jitter, RFC 3550
constexpr double kSlowShare = 1.0 / 64;  // in the round trip

}  // namespace

void LinkMeter::receive(std::uint64_t sequence, double sent_s, double answered_s,
                        double now_s) noexcept {
  ++arrived_;
  newest_ = std::max(newest_, sequence);
  const double way = now_s - sent_s;
  if (!std::isfinite(way + answered_s)) return;
  if (has_way_) jitter_ += kShare * (std::abs(way - way_) - jitter_);
  way_ = way;
  has_way_ = true;
  if (answered_s <= 0.0) return;
  const double trip = now_s - answered_s;
  round_trip_ = round_trip_ > 0.0 ? round_trip_ + kSlowShare * (trip - round_trip_) : trip;
}

void LinkMeter::step(double now_s) noexcept {
  if (!has_window_) {
    has_window_ = newest_ > 0;
    window_s_ = now_s;
  } else if (now_s - window_s_ < kWindow) {
    return;
  } else {
    const auto sent = static_cast<double>(newest_ - before_);
    loss_ = sent > 0.0 ? std::clamp(1.0 - static_cast<double>(arrived_) / sent, 0.0, 1.0) : 1.0;
    window_s_ = now_s;
  }
  before_ = newest_;
  arrived_ = 0;
}

}  // namespace hg::teleoperation
