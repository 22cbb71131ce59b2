#include "hg/device/udp/session_host.h"

#include <fmt/format.h>
#include <sodium/crypto_shorthash.h>
#include <sodium/randombytes.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "hg/device/udp/agreement.h"

namespace hg::udp {
namespace {

constexpr int kGoodbyes = 3;                 // not acknowledged: one may be lost
constexpr std::size_t kMostCandidates = 16;  // remembered candidates
constexpr std::size_t kMostAnswer = 2;  // times the bytes of a hello, whose sender may be forged
constexpr std::size_t kNetwork = 28;    // bytes of the headers of IPv4 and UDP

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

}  // namespace

SessionHost::SessionHost(const Address& address, const HostConfig& config)
    : config_(config), socket_(UdpSocket::listening_at(address)) {
  static_assert(sizeof secret_ == crypto_shorthash_KEYBYTES);
  randombytes_buf(secret_.data(), secret_.size());
  if (!config.capture.empty()) capture_ = std::make_unique<Capture>(config.capture);
}

std::string SessionHost::client() const {
  return fmt::format("{} at {}", hello_.client.printable(), to_string(client_));
}

void SessionHost::send_bytes(std::span<const std::byte> datagram, const Peer& to) {
  socket_.send(datagram, to);
  if (capture_) capture_->add(now_ns(), datagram);
}

Heard SessionHost::hear(Header& header) {
  Peer from;
  if (!socket_.receive(datagram_, from)) return Heard::kNothing;
  if (capture_) capture_->add(now_ns(), datagram_.view());
  const DatagramCheck verdict = read_header(datagram_.view(), header, config_.key);
  const bool is_whole = verdict == DatagramCheck::kGood ||
                        verdict == DatagramCheck::kWrongVersion ||
                        verdict == DatagramCheck::kForged;
  if (is_whole && header.type == static_cast<std::uint16_t>(MessageType::kHello)) {
    on_hello(header, verdict, from);
    return Heard::kIgnored;
  }
  return has_client_ ? hear_client(verdict, header, from) : hear_candidate(verdict, header, from);
}

// a session begins with a hello; leftovers of an old one do not count for the next
Heard SessionHost::hear_client(DatagramCheck verdict, const Header& header, const Peer& from) {
  if (!(from == client_)) {
    if (from_others_++ == 0) first_other_ = from;
    return Heard::kIgnored;
  }
  return inbox_.accept(verdict, header) ? Heard::kMessage : Heard::kIgnored;
}

Heard SessionHost::hear_candidate(DatagramCheck verdict, const Header& header, const Peer& from) {
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    Candidate& candidate = candidates_[i];
    if (!(from == candidate.peer) || !candidate.inbox.accept(verdict, header)) continue;
    const auto type = static_cast<MessageType>(header.type);
    if (type == config_.begin) {
      begin_session(candidate);
      return Heard::kMessage;
    }
    if (type == MessageType::kGoodbye) {
      candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return Heard::kIgnored;
  }
  const bool begins =
      verdict == DatagramCheck::kGood && header.type == static_cast<std::uint16_t>(config_.begin);
  if (!begins || !was_welcomed(from, header.session)) return Heard::kIgnored;
  // its hello was forgotten: many have arrived since
  Candidate candidate{.peer = from,
                      .hello = {.client = "a client"},
                      .outbox = Outbox(header.session, config_.key),
                      .inbox = Inbox(header.session, Side::kClient)};
  if (!candidate.inbox.accept(verdict, header)) return Heard::kIgnored;
  begin_session(candidate);
  return Heard::kMessage;
}

// Number of the next session if it is the one of `peer`, welcomed at that time. A client that sends
// it has received the welcome: no record of other clients is needed, however many there are.
std::uint32_t SessionHost::session_for(const Peer& peer, std::int64_t time_ns) const noexcept {
  const std::int64_t slot = time_ns / std::max<std::int64_t>(1, ns(config_.ready_timeout_s));
  std::array<unsigned char, sizeof sessions_ + sizeof slot + sizeof peer.address> facts{};
  std::memcpy(facts.data(), &sessions_, sizeof sessions_);
  std::memcpy(facts.data() + sizeof sessions_, &slot, sizeof slot);
  std::memcpy(facts.data() + sizeof sessions_ + sizeof slot, &peer.address, peer.length);
  std::array<unsigned char, crypto_shorthash_BYTES> hash{};
  crypto_shorthash(hash.data(), facts.data(), facts.size(), secret_.data());
  std::uint32_t session = 0;
  std::memcpy(&session, hash.data(), sizeof session);
  return session | 1U;  // never 0
}

// welcomed at most twice the ready time-out ago
bool SessionHost::was_welcomed(const Peer& peer, std::uint32_t session) const noexcept {
  const std::int64_t now = now_ns();
  return session == session_for(peer, now) ||
         session == session_for(peer, now - ns(config_.ready_timeout_s));
}

// the other candidates are notified that they are too late
void SessionHost::begin_session(const Candidate& chosen) {
  has_client_ = true;
  ++sessions_;
  client_ = chosen.peer;
  hello_ = chosen.hello;
  outbox_ = chosen.outbox;
  inbox_ = chosen.inbox;
  refused_ = malformed_ = foreign_ = from_others_ = 0;
  const std::string reason = hello_.client.printable() + " has the " + config_.what;
  for (Candidate& other : candidates_) {
    if (&other == &chosen) continue;
    for (int i = 0; i < kGoodbyes; ++i) {
      send(Goodbye{Farewell::kDone, reason}, other.outbox, other.peer);
    }
  }
  candidates_.clear();
}

// a repeated hello belongs to the same candidate
SessionHost::Candidate& SessionHost::candidate_of(const Hello& hello, const Peer& from) {
  const std::uint32_t session = session_for(from, now_ns());
  for (Candidate& candidate : candidates_) {
    if (candidate.peer == from && candidate.hello.nonce == hello.nonce) return candidate;
  }
  std::erase_if(candidates_, [&](const Candidate& other) { return other.peer == from; });
  if (candidates_.size() == kMostCandidates) candidates_.erase(candidates_.begin());
  return candidates_.emplace_back(Candidate{.peer = from,
                                            .hello = hello,
                                            .outbox = Outbox(session, config_.key),
                                            .inbox = Inbox(session, Side::kClient),
                                            .give_up_ns = now_ns() + ns(config_.ready_timeout_s)});
}

void SessionHost::on_hello(const Header& header, DatagramCheck verdict, const Peer& from) {
  if (verdict == DatagramCheck::kWrongVersion) {
    refuse(ConnectionRefusal::kProtocol,
           fmt::format("protocol: version {}, expected {}", kVersion, header.version), 0, from);
    return;
  }
  Hello hello;
  if (!take(hello)) return;
  if (verdict == DatagramCheck::kForged) {
    refuse(ConnectionRefusal::kKey,
           config_.key.is_set() ? "its key is another one, or none was given (--key-file)"
                                : "it has no key (--key-file), and none may be given",
           hello.nonce, from);
    return;
  }
  const bool is_client = has_client_ && from == client_ && hello.nonce == hello_.nonce;
  if (has_client_ && !is_client) {
    refuse(ConnectionRefusal::kBusy, fmt::format("{} has the {}", client(), config_.what),
           hello.nonce, from);
    return;
  }
  const std::string unlike = difference(config_.actual, hello.expected);
  if (!unlike.empty()) {
    refuse(ConnectionRefusal::kMismatch, unlike, hello.nonce, from);
    return;
  }
  welcome(hello, from, is_client);
}

void SessionHost::welcome(const Hello& hello, const Peer& from, bool is_client) {
  const Welcome welcome{.nonce = hello.nonce,
                        .is_simulated = config_.is_simulated,
                        .actual = config_.actual,
                        .command_timeout_s = config_.silence_s,
                        .server = config_.server};
  if (is_client) {
    send(welcome);
  } else {
    Candidate& candidate = candidate_of(hello, from);
    send(welcome, candidate.outbox, candidate.peer);
  }
}

void SessionHost::refuse(ConnectionRefusal refusal, const std::string& reason, std::uint64_t nonce,
                         const Peer& to) {
  ++refused_;
  Outbox outbox(0);  // without a tag, so that a client with another key or none can read it
  const std::span<const std::byte> answer = outbox.encode(Welcome{.nonce = nonce,
                                                                  .refusal = refusal,
                                                                  .actual = config_.actual,
                                                                  .server = config_.server,
                                                                  .reason = reason});
  if (answer.size() + kNetwork <= kMostAnswer * (datagram_.size + kNetwork)) send_bytes(answer, to);
}

void SessionHost::leave(const Goodbye& goodbye) {
  for (int i = 0; i < kGoodbyes; ++i) send(goodbye);
  end_session();
}

void SessionHost::forget_late_candidates() {
  std::erase_if(candidates_, [now = now_ns()](const Candidate& candidate) {
    return now > candidate.give_up_ns;
  });
}

LinkCounts SessionHost::counts() const noexcept {
  LinkCounts counts = inbox_.counts();
  counts.sent = outbox_.number();
  counts.malformed = malformed_;
  counts.foreign += foreign_;
  counts.refused = refused_;
  counts.from_others = from_others_;
  return counts;
}

}  // namespace hg::udp
