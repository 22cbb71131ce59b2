#include "hg/teleoperation/remote_udp/answer_gate.h"

#include <cmath>

#include "hg/teleoperation/remote_udp/plausible.h"

namespace hg::teleoperation {
namespace {

constexpr double kSilence = 0.2;    // s without a packet of use
constexpr double kJumpSpeed = 3.0;  // m/s or rad/s
constexpr double kRounding = 5e-3;  // m or rad

}  // namespace

bool AnswerGate::has_jumped(const RemotePacket& packet) const noexcept {
  if (good_.sequence == 0) return false;
  const double way = (packet.x - good_.x).lpNorm<Eigen::Infinity>();
  return way > kJumpSpeed * (packet.sent_s - good_.sent_s) + kRounding;
}

bool AnswerGate::pass_as(RemoteCause cause, RemotePacket& passed) const noexcept {
  if (good_.sequence == 0) return false;
  passed = good_;
  passed.cause = cause;
  return true;
}

bool AnswerGate::take(const RemotePacket& packet, double now_s, RemotePacket& passed) noexcept {
  if (packet.sequence <= sequence_) {
    ++repeated_;
    return false;
  }
  const bool is_frozen = sequence_ > 0 && packet.sent_s <= sent_s_;
  sequence_ = packet.sequence;
  if (is_frozen) {
    ++frozen_;
    return false;
  }
  if (!is_plausible(packet, size_)) return pass_as(RemoteCause::kNotFinite, passed);
  sent_s_ = packet.sent_s;
  if (has_jumped(packet)) return pass_as(RemoteCause::kJump, passed);
  good_ = packet;
  if (good_.model.normal.size() == 0) good_.model.normal = PortVector::Zero(size_);
  used_s_ = now_s;
  repeated_ = frozen_ = 0;
  passed = good_;
  return true;
}

bool AnswerGate::check(double now_s, RemotePacket& passed) noexcept {
  if (repeated_ + frozen_ == 0 || now_s - used_s_ <= kSilence) return false;
  const RemoteCause cause = frozen_ > 0 ? RemoteCause::kFrozen : RemoteCause::kReplayed;
  repeated_ = frozen_ = 0;
  return pass_as(cause, passed);
}

bool AnswerGate::begin_again(RemotePacket& passed) noexcept {
  const bool is_passed = pass_as(RemoteCause::kSilent, passed);
  *this = AnswerGate(size_);
  return is_passed;
}

}  // namespace hg::teleoperation
