#include "hg/teleoperation/remote_udp/udp_remote.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hg::teleoperation {
namespace {

constexpr int kMostAtOnce = 64;                    // datagrams per period
constexpr std::int64_t kTermsPeriod = 20'000'000;  // ns, until the machine answers; lock-step: all
constexpr std::int64_t kSilent = 500'000'000;      // ns, after which the machine is asked for
constexpr std::int64_t kAskPeriod = 100'000'000;   // ns
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

udp::GuestConfig guest_of(const UdpRemoteConfig& config) {
  return {.expected = to_message(config.description),
          .what = "remote machine",
          .command = "hapticgiant simulate --remote --listen",
          .client = config.client,
          .answer_timeout_s = config.answer_timeout_s,
          .key = config.key};
}

}  // namespace

UdpRemote::UdpRemote(const udp::Address& address, const UdpRemoteConfig& config)
    : config_(config), guest_(address, guest_of(config)), gate_(config.description.size) {
  heard_ns_ = now_ns();
}

UdpRemote::~UdpRemote() { guest_.leave({udp::Farewell::kDone, "done"}); }

// The newest counts: energies are sums, and what overtakes replaces.
void UdpRemote::send(const LeaderPacket& packet, double /*now_s*/) noexcept {
  if (packet.sequence > message_.packet.sequence) message_.packet = packet;
}

void UdpRemote::step(double now_s) noexcept {
  ++message_.period;
  message_.time_s = now_s;
  say();
  if (config_.description.is_lock_step) {
    await_answer(now_s);
  } else {
    drain(now_s);
    look_for_machine();
  }
  message_.packet.sequence = 0;
  if (gate_.check(now_s, passed_)) give(passed_, now_s);
}

void UdpRemote::say() noexcept {
  const std::int64_t now = now_ns();
  const bool is_due = now - terms_ns_ >= kTermsPeriod;
  if (!has_begun_ && is_due) {
    guest_.send(to_message(config_.method));
    terms_ns_ = now;
  }
  guest_.send(message_);
}

void UdpRemote::await_answer(double now_s) noexcept {
  if (is_gone_) return;
  const std::int64_t deadline = now_ns() + std::llround(1e9 * config_.lock_step_timeout_s);
  while (true) {
    drain(now_s);
    if (arrived_.period == message_.period) return;
    if (is_gone_ || now_ns() >= deadline) break;
    const std::int64_t again = now_ns() + kTermsPeriod;
    guest_.wait(again);
    if (now_ns() >= again) say();
  }
  is_gone_ = true;
}

void UdpRemote::look_for_machine() noexcept {
  const std::int64_t now = now_ns();
  if (now - heard_ns_ < kSilent || now - asked_ns_ < kAskPeriod) return;
  guest_.ask_again();
  asked_ns_ = now;
}

void UdpRemote::notice_session(double now_s) noexcept {
  if (guest_.sessions() == session_) return;
  session_ = guest_.sessions();
  has_begun_ = false;
  way_s_ = round_trip_s_ = kInfinity;
  terms_ns_ = 0;
  if (gate_.begin_again(passed_)) give(passed_, now_s);
  numbered_from_ = given_;
}

void UdpRemote::drain(double now_s) noexcept {
  for (int i = 0; i < kMostAtOnce; ++i) {
    udp::Header header;
    const udp::Heard heard = guest_.hear(header);
    if (heard == udp::Heard::kNothing) return;
    notice_session(now_s);
    if (heard == udp::Heard::kIgnored) continue;
    switch (static_cast<udp::MessageType>(header.type)) {
      case udp::MessageType::kRemote:
        take(now_s);
        break;
      case udp::MessageType::kGoodbye:
        is_gone_ = true;
        heard_ns_ = 0;
        break;
      case udp::MessageType::kWelcome:
        break;
      default:
        guest_.count_foreign();
    }
  }
}

// One that cannot be decoded counts as one whose numbers are none.
void UdpRemote::take(double now_s) noexcept {
  const std::uint64_t period = arrived_.period;
  const std::uint64_t sequence = arrived_.packet.sequence;
  if (!guest_.take(arrived_)) {
    arrived_ = {.period = period, .packet = {.sequence = sequence + 1, .sent_s = kNoNumber}};
  }
  has_begun_ = true;
  heard_ns_ = now_ns();
  if (gate_.take(arrived_.packet, now_s, passed_)) give(passed_, now_s);
}

// Numbers and times of the machine become those of the leader: they continue over sessions, and the
// fastest packet was on its way for half of the shortest round trip.
void UdpRemote::give(const RemotePacket& packet, double now_s) noexcept {
  if (count_ == kRoom) return;
  RemotePacket& given = waiting_[(first_ + count_++) % kRoom];
  given = packet;
  given_ = std::max(given_ + 1, numbered_from_ + packet.sequence);
  given.sequence = given_;
  if (!config_.description.is_lock_step) {
    const double way = now_s - packet.sent_s;
    way_s_ = std::min(way_s_, way);
    if (packet.answered_s > 0.0) {
      round_trip_s_ = std::min(round_trip_s_, now_s - packet.answered_s);
    }
    const double shortest = round_trip_s_ == kInfinity ? 0.0 : 0.5 * round_trip_s_;
    given.sent_s = now_s - (way - way_s_) - std::max(0.0, shortest);
  }
  constexpr double kLeast = 1e-9;  // s
  given.sent_s = std::max(given.sent_s, given_s_ + kLeast);
  given_s_ = given.sent_s;
}

bool UdpRemote::receive(RemotePacket& packet) noexcept {
  if (count_ == 0) return false;
  packet = waiting_[first_];
  first_ = (first_ + 1) % kRoom;
  --count_;
  return true;
}

}  // namespace hg::teleoperation
