#include "hg/device/udp/session_guest.h"

#include <fmt/format.h>
#include <sodium/randombytes.h>

#include <algorithm>
#include <cmath>

#include "hg/core/error.h"
#include "hg/device/udp/agreement.h"

namespace hg::udp {
namespace {

constexpr std::int64_t kHelloPeriod = 100'000'000;  // ns
constexpr int kGoodbyes = 3;                        // not acknowledged: one may be lost

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

std::uint64_t random_number() noexcept {
  std::uint64_t number = 0;
  randombytes_buf(&number, sizeof number);
  return number;
}

}  // namespace

SessionGuest::SessionGuest(const Address& address, const GuestConfig& config)
    : config_(config), socket_(UdpSocket::talking_to(address)), outbox_(0, config.key) {
  connect(address.host + ":" + address.port);
}

void SessionGuest::connect(const std::string& at) {
  nonce_ = random_number();
  is_asking_ = true;
  const std::int64_t busy_until = now_ns() + ns(config_.busy_patience_s);
  const std::int64_t deadline = now_ns() + ns(config_.answer_timeout_s + config_.busy_patience_s);
  while (now_ns() < deadline) {
    send(Hello{nonce_, config_.expected, config_.client});
    const std::int64_t again = std::min(now_ns() + kHelloPeriod, deadline);
    while (now_ns() < again) {
      socket_.wait(again);
      if (is_joined(at, now_ns() < busy_until)) return;
      if (socket_.was_refused()) break;  // port closed: try again later
    }
    while (now_ns() < again) socket_.wait(again);
  }
  throw SetupError(
      fmt::format("{}: no {} answers there within {:g} s; is its server running ({} {})?", at,
                  config_.what, config_.answer_timeout_s, config_.command, at));
}

// whether a datagram was the welcome
bool SessionGuest::is_joined(const std::string& at, bool is_patient) {
  Peer from;
  if (!socket_.receive(datagram_, from)) return false;
  Header header;
  const DatagramCheck verdict = read_header(datagram_.view(), header, config_.key);
  switch (answer(verdict, header)) {
    case Answer::kNone:
      return false;
    case Answer::kJoined:
      return true;
    case Answer::kVersion:
      throw SetupError(fmt::format("{}: the {} speaks version {} of the protocol, this program {}",
                                   at, config_.what, header.version, kVersion));
    case Answer::kForged:
      throw SetupError(fmt::format(
          "{}: the {}'s answer is not of the key that was given (--key-file)", at, config_.what));
    case Answer::kBusy:
      if (is_patient) return false;  // try again
      break;
    case Answer::kRefused:
      break;
    case Answer::kUnlike:
      throw SetupError(fmt::format("{}: the {} does not fit: {}", at, config_.what,
                                   difference(heard_welcome_.actual, config_.expected)));
  }
  throw SetupError(
      fmt::format("{}: the {} refuses: {}", at, config_.what, heard_welcome_.reason.printable()));
}

SessionGuest::Answer SessionGuest::answer(DatagramCheck verdict, const Header& header) noexcept {
  if (verdict == DatagramCheck::kWrongVersion) return Answer::kVersion;
  // a host with another key or none can report just that
  const bool is_forged = verdict == DatagramCheck::kForged;
  if (!(verdict == DatagramCheck::kGood || is_forged) ||
      header.type != static_cast<std::uint16_t>(MessageType::kWelcome)) {
    return Answer::kNone;
  }
  if (!decode(datagram_.view(), heard_welcome_) || heard_welcome_.nonce != nonce_) {
    return Answer::kNone;
  }
  const ConnectionRefusal refusal = heard_welcome_.refusal;
  if (is_forged && refusal == ConnectionRefusal::kNone) return Answer::kForged;
  if (refusal == ConnectionRefusal::kBusy) return Answer::kBusy;
  if (refusal != ConnectionRefusal::kNone) return Answer::kRefused;
  if (!difference(heard_welcome_.actual, config_.expected).empty()) return Answer::kUnlike;
  Inbox inbox(header.session, Side::kServer);
  if (!inbox.accept(verdict, header)) return Answer::kNone;
  welcome_ = heard_welcome_;
  inbox_ = inbox;
  outbox_.join(header.session);
  is_asking_ = false;
  ++sessions_;
  return Answer::kJoined;
}

Heard SessionGuest::hear(Header& header) noexcept {
  Peer from;
  if (!socket_.receive(datagram_, from)) return Heard::kNothing;
  const DatagramCheck verdict = read_header(datagram_.view(), header, config_.key);
  if (is_asking_ && answer(verdict, header) == Answer::kJoined) return Heard::kIgnored;
  return inbox_.accept(verdict, header) ? Heard::kMessage : Heard::kIgnored;
}

void SessionGuest::ask_again() noexcept {
  if (!is_asking_) nonce_ = random_number();
  is_asking_ = true;
  Outbox outbox(0, config_.key);
  socket_.send(outbox.encode(Hello{nonce_, config_.expected, config_.client}));
}

void SessionGuest::leave(const Goodbye& goodbye) noexcept {
  for (int i = 0; i < kGoodbyes; ++i) send(goodbye);
}

LinkCounts SessionGuest::counts() const noexcept {
  LinkCounts counts = inbox_.counts();
  counts.sent = outbox_.number();
  counts.malformed = malformed_;
  counts.foreign += foreign_;
  return counts;
}

}  // namespace hg::udp
