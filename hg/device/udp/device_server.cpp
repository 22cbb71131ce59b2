#include "hg/device/udp/device_server.h"

#include <fmt/format.h>
#include <sodium/crypto_shorthash.h>
#include <sodium/randombytes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "hg/core/schedule.h"
#include "hg/device/udp/agreement.h"
#include "hg/device/udp/capture.h"
#include "hg/device/udp/inbox.h"
#include "hg/device/udp/outbox.h"
#include "hg/device/udp/round_trip.h"
#include "hg/device/udp/udp_socket.h"

namespace hg::udp {
namespace {

constexpr std::int64_t kLook = 100'000'000;  // ns, between two checks whether to stop
constexpr int kGoodbyes = 3;                 // not acknowledged: one may be lost
constexpr std::size_t kMostCandidates = 16;  // remembered candidates
constexpr std::size_t kMostAnswer = 2;  // times the bytes of a hello, whose sender may be forged
constexpr std::size_t kNetwork = 28;    // bytes of the headers of IPv4 and UDP
constexpr std::int64_t kFirstPatience = 1'000'000'000;  // ns, with the drives off
constexpr std::int64_t kReportPeriod = 100'000'000;     // ns, of round trips
constexpr std::size_t kRemembered = 2048;               // frames whose answers are timed

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

}  // namespace

/// What DeviceServer does, with the socket and what it knows of its clients.
class Server {
 public:
  Server(const Address& address, const ServerConfig& config);

  // as DeviceServer
  std::string address() const { return to_string(socket_.own_address()); }
  std::string capture_error() { return capture_ ? capture_->flush() : ""; }
  bool wait_for_client(const std::atomic<bool>& stop);
  SessionReport serve(device::Device& device, const std::atomic<bool>& stop);

 private:
  enum class Event { kNone, kReady, kCommand, kGoodbye };
  /// Client that is welcomed and not ready yet. There may be several: the first that is ready gets
  /// the device, even when it is not among those remembered.
  struct Candidate {
    Peer peer;
    Hello hello;
    Outbox outbox;
    Inbox inbox;
    std::int64_t give_up_ns = 0;
  };
  Event receive();
  Event hear(DatagramCheck verdict, const Header& header, const Peer& from);
  Event hear_candidate(DatagramCheck verdict, const Header& header, const Peer& from);
  void begin_session(const Candidate& chosen);
  Candidate& candidate_of(const Hello& hello, const Peer& from);
  std::uint32_t session_for(const Peer& peer, std::int64_t time_ns) const noexcept;
  bool was_welcomed(const Peer& peer, std::uint32_t session) const noexcept;
  Event take(const Header& header);
  void on_hello(const Header& header, DatagramCheck verdict, const Peer& from);
  void refuse(ConnectionRefusal refusal, const std::string& reason, std::uint64_t nonce,
              const Peer& to);
  void live_in_real_time(device::Device& device, const std::atomic<bool>& stop);
  void live_in_lock_step(device::Device& device, const std::atomic<bool>& stop);
  void close_session(bool is_stopped);
  bool answered(const std::atomic<bool>& stop);
  void measure_answer();
  void report_round_trip();
  template <typename Message>
  void send(const Message& message) {
    send(message, outbox_, client_);
  }
  template <typename Message>
  void send(const Message& message, Outbox& outbox, const Peer& to);
  void send_bytes(std::span<const std::byte> datagram, const Peer& to);

  ServerConfig config_;
  UdpSocket socket_;
  std::unique_ptr<Capture> capture_;
  /// Secret for session numbers: a client that answers with its number was welcomed at its address.
  std::array<unsigned char, crypto_shorthash_KEYBYTES> secret_{};
  std::uint64_t sessions_ = 0;         ///< number of sessions; a number is valid for one only
  std::vector<Candidate> candidates_;  ///< oldest first, one per address
  bool has_client_ = false;
  Peer client_;
  Hello hello_;
  Outbox outbox_{0};
  Inbox inbox_{0};
  Datagram datagram_;
  SensorFrame frame_;
  CommandFrame arrived_, command_;  ///< `command_` is in effect
  bool has_command_ = false;        ///< a command has arrived in this session
  bool has_left_ = false;           ///< the client has sent a goodbye
  std::int64_t frame_ns_ = 0, heard_ns_ = 0;
  std::array<std::int64_t, kRemembered> sent_ns_{};  ///< of the newest frames, by their sequence
  std::int64_t answers_ = 0, answers_ns_ = 0, longest_answer_ns_ = 0;
  std::int64_t reported_ = 0, reported_ns_ = 0,
               due_report_ns_ = 0;  ///< answers that the client knows, and when more are due
  std::uint64_t refused_ = 0, late_ = 0, malformed_ = 0, foreign_ = 0, from_others_ = 0;
  Peer first_other_;
  SessionReport report_;
};

Server::Server(const Address& address, const ServerConfig& config)
    : config_(config), socket_(UdpSocket::listening_at(address)) {
  randombytes_buf(secret_.data(), secret_.size());
  if (!config.capture.empty()) capture_ = std::make_unique<Capture>(config.capture);
}

void Server::send_bytes(std::span<const std::byte> datagram, const Peer& to) {
  socket_.send(datagram, to);
  if (capture_) capture_->add(now_ns(), datagram);
}

template <typename Message>
void Server::send(const Message& message, Outbox& outbox, const Peer& to) {
  send_bytes(outbox.encode(message), to);
}

// receives one datagram, if any waits
Server::Event Server::receive() {
  Peer from;
  if (!socket_.receive(datagram_, from)) return Event::kNone;
  if (capture_) capture_->add(now_ns(), datagram_.view());
  Header header;
  const DatagramCheck verdict = read_header(datagram_.view(), header, config_.key);
  const bool is_whole = verdict == DatagramCheck::kGood ||
                        verdict == DatagramCheck::kWrongVersion ||
                        verdict == DatagramCheck::kForged;
  if (is_whole && header.type == static_cast<std::uint16_t>(MessageType::kHello)) {
    on_hello(header, verdict, from);
    return Event::kNone;
  }
  return hear(verdict, header, from);
}

// a session begins with a hello; leftovers of an old one do not count for the next
Server::Event Server::hear(DatagramCheck verdict, const Header& header, const Peer& from) {
  if (!has_client_) return hear_candidate(verdict, header, from);
  if (!(from == client_)) {
    if (from_others_++ == 0) first_other_ = from;
    return Event::kNone;
  }
  return inbox_.accept(verdict, header) ? take(header) : Event::kNone;
}

Server::Event Server::hear_candidate(DatagramCheck verdict, const Header& header,
                                     const Peer& from) {
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    Candidate& candidate = candidates_[i];
    if (!(from == candidate.peer) || !candidate.inbox.accept(verdict, header)) continue;
    const auto type = static_cast<MessageType>(header.type);
    if (type == MessageType::kReady) {
      begin_session(candidate);
      return Event::kReady;
    }
    if (type == MessageType::kGoodbye) {
      candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return Event::kNone;
  }
  const bool is_ready = verdict == DatagramCheck::kGood &&
                        header.type == static_cast<std::uint16_t>(MessageType::kReady);
  if (!is_ready || !was_welcomed(from, header.session)) return Event::kNone;
  // its hello was forgotten: many have arrived since
  Candidate candidate{.peer = from,
                      .hello = {.client = "a client"},
                      .outbox = Outbox(header.session, config_.key),
                      .inbox = Inbox(header.session)};
  if (!candidate.inbox.accept(verdict, header)) return Event::kNone;
  begin_session(candidate);
  return Event::kReady;
}

// Number of the next session if it is the one of `peer`, welcomed at that time. A client that sends
// it has received the welcome: no record of other clients is needed, however many there are.
std::uint32_t Server::session_for(const Peer& peer, std::int64_t time_ns) const noexcept {
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
bool Server::was_welcomed(const Peer& peer, std::uint32_t session) const noexcept {
  const std::int64_t now = now_ns();
  return session == session_for(peer, now) ||
         session == session_for(peer, now - ns(config_.ready_timeout_s));
}

// the other candidates are notified that they are too late
void Server::begin_session(const Candidate& chosen) {
  has_client_ = true;
  ++sessions_;
  client_ = chosen.peer;
  hello_ = chosen.hello;
  outbox_ = chosen.outbox;
  inbox_ = chosen.inbox;
  const std::string reason = hello_.client.printable() + " has the device";
  for (Candidate& other : candidates_) {
    if (&other == &chosen) continue;
    for (int i = 0; i < kGoodbyes; ++i) {
      send(Goodbye{Farewell::kDone, reason}, other.outbox, other.peer);
    }
  }
  candidates_.clear();
}

// a repeated hello belongs to the same candidate
Server::Candidate& Server::candidate_of(const Hello& hello, const Peer& from) {
  const std::uint32_t session = session_for(from, now_ns());
  for (Candidate& candidate : candidates_) {
    if (candidate.peer == from && candidate.hello.nonce == hello.nonce) return candidate;
  }
  std::erase_if(candidates_, [&](const Candidate& other) { return other.peer == from; });
  if (candidates_.size() == kMostCandidates) candidates_.erase(candidates_.begin());
  return candidates_.emplace_back(Candidate{.peer = from,
                                            .hello = hello,
                                            .outbox = Outbox(session, config_.key),
                                            .inbox = Inbox(session),
                                            .give_up_ns = now_ns() + ns(config_.ready_timeout_s)});
}

Server::Event Server::take(const Header& header) {
  switch (static_cast<MessageType>(header.type)) {
    case MessageType::kReady:
      return Event::kReady;
    case MessageType::kCommand:
      if (!decode(datagram_.view(), arrived_) || !fits(config_.actual, arrived_) ||
          arrived_.sequence > frame_.sequence) {  // answers a frame that was never sent
        ++malformed_;
        return Event::kNone;
      }
      return Event::kCommand;
    case MessageType::kGoodbye: {
      Goodbye goodbye;
      if (!decode(datagram_.view(), goodbye)) ++malformed_;
      report_.farewell = goodbye.reason.printable();
      has_left_ = true;
      return Event::kGoodbye;
    }
    case MessageType::kHello:
    case MessageType::kWelcome:
    case MessageType::kSensors:
    case MessageType::kRoundTrip:
      break;
  }
  ++foreign_;
  return Event::kNone;
}

void Server::on_hello(const Header& header, DatagramCheck verdict, const Peer& from) {
  if (verdict == DatagramCheck::kWrongVersion) {
    refuse(ConnectionRefusal::kProtocol,
           fmt::format("protocol: version {}, expected {}", kVersion, header.version), 0, from);
    return;
  }
  Hello hello;
  if (!decode(datagram_.view(), hello)) {
    ++malformed_;
    return;
  }
  if (verdict == DatagramCheck::kForged) {
    refuse(ConnectionRefusal::kKey,
           config_.key.is_set() ? "its key is another one, or none was given (--key-file)"
                                : "it has no key (--key-file), and none may be given",
           hello.nonce, from);
    return;
  }
  const bool is_client = has_client_ && from == client_ && hello.nonce == hello_.nonce;
  if (has_client_ && !is_client) {
    refuse(ConnectionRefusal::kBusy,
           fmt::format("{} at {} has the device", hello_.client.printable(), to_string(client_)),
           hello.nonce, from);
    return;
  }
  const std::string unlike = difference(config_.actual, hello.expected);
  if (!unlike.empty()) {
    refuse(ConnectionRefusal::kMismatch, unlike, hello.nonce, from);
    return;
  }
  const Welcome welcome{.nonce = hello.nonce,
                        .is_simulated = config_.is_simulated,
                        .actual = config_.actual,
                        .command_timeout_s = config_.actual.is_lock_step
                                                 ? config_.lock_step_timeout_s
                                                 : config_.command_timeout_s,
                        .server = config_.server};
  if (is_client) {
    send(welcome);
  } else {
    Candidate& candidate = candidate_of(hello, from);
    send(welcome, candidate.outbox, candidate.peer);
  }
}

void Server::refuse(ConnectionRefusal refusal, const std::string& reason, std::uint64_t nonce,
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

bool Server::wait_for_client(const std::atomic<bool>& stop) {
  has_client_ = false;
  while (!stop.load()) {
    if (receive() == Event::kReady) return true;
    std::erase_if(candidates_, [now = now_ns()](const Candidate& candidate) {
      return now > candidate.give_up_ns;
    });
    socket_.wait(now_ns() + kLook);
  }
  return false;
}

SessionReport Server::serve(device::Device& device, const std::atomic<bool>& stop) {
  report_ = {};
  report_.client = fmt::format("{} at {}", hello_.client.printable(), to_string(client_));
  answers_ = answers_ns_ = longest_answer_ns_ = reported_ = reported_ns_ = due_report_ns_ = 0;
  refused_ = late_ = malformed_ = foreign_ = from_others_ = 0;
  sent_ns_.fill(0);
  command_ = off_command(config_.actual);
  has_command_ = false;
  heard_ns_ = now_ns();

  has_left_ = false;
  if (config_.actual.is_lock_step) {
    live_in_lock_step(device, stop);
  } else {
    live_in_real_time(device, stop);
  }
  device.write(off_command(config_.actual));
  close_session(stop.load());
  return report_;
}

void Server::close_session(bool is_stopped) {
  const bool is_silent = !has_left_ && !is_stopped;
  if (!has_left_) {
    const Goodbye goodbye{is_silent ? Farewell::kSilent : Farewell::kDone,
                          is_silent ? "no command came in time: drives off, brakes closed"
                                    : "the server was stopped"};
    for (int i = 0; i < kGoodbyes; ++i) send(goodbye);
  }
  report_.end = has_left_   ? SessionEnd::kClientLeft
                : is_silent ? SessionEnd::kClientSilent
                            : SessionEnd::kStopped;
  if (answers_ > 0) {
    report_.mean_answer_s = 1e-9 * static_cast<double>(answers_ns_) / static_cast<double>(answers_);
  }
  report_.max_answer_s = 1e-9 * static_cast<double>(longest_answer_ns_);
  const std::uint64_t held = report_.link.held, repeated = report_.link.repeated;
  report_.link = inbox_.counts();
  report_.link.sent = outbox_.number();
  report_.link.held = held;
  report_.link.repeated = repeated;
  report_.link.late = late_;
  report_.link.malformed = malformed_;
  report_.link.foreign += foreign_;
  report_.link.refused = refused_;
  report_.link.from_others = from_others_;
  if (from_others_ > 0) report_.other = to_string(first_other_);
  has_client_ = false;
}

// of the command that has arrived, whether or not it comes too late to be followed
void Server::measure_answer() {
  const std::int64_t sent_ns = sent_ns_[arrived_.sequence % kRemembered];
  if (sent_ns == 0 || arrived_.sequence + kRemembered <= frame_.sequence) return;
  const std::int64_t time = now_ns() - sent_ns;
  ++answers_;
  answers_ns_ += time;
  longest_answer_ns_ = std::max(longest_answer_ns_, time);
}

void Server::report_round_trip() {
  if (answers_ == reported_ || now_ns() < due_report_ns_) return;
  send(RoundTrip{1e-9 * static_cast<double>(answers_ns_ - reported_ns_) /
                 static_cast<double>(answers_ - reported_)});
  reported_ = answers_;
  reported_ns_ = answers_ns_;
  due_report_ns_ = now_ns() + kReportPeriod;
}

void Server::live_in_real_time(device::Device& device, const std::atomic<bool>& stop) {
  Schedule schedule(now_ns(), std::llround(1e9 / config_.actual.rate_Hz));
  const std::int64_t timeout = ns(config_.command_timeout_s);
  // age of the frame that a command answers: a client that falls behind must not be followed
  const auto most_periods =
      static_cast<std::uint64_t>(config_.command_timeout_s * config_.actual.rate_Hz);
  const auto patience = [&] { return has_command_ ? timeout : std::max(timeout, kFirstPatience); };
  while (!stop.load() && now_ns() - heard_ns_ <= patience()) {
    device.read(frame_);
    frame_ns_ = sent_ns_[frame_.sequence % kRemembered] = now_ns();
    send(frame_);
    report_round_trip();
    report_.overruns += schedule.advance(frame_ns_);
    bool is_new = false;
    do {
      for (Event event = receive(); event != Event::kNone; event = receive()) {
        if (event == Event::kGoodbye) return;
        if (event != Event::kCommand) continue;
        measure_answer();
        if (inbox_.was_overtaken() || arrived_.sequence + most_periods < frame_.sequence) {
          ++late_;
          continue;
        }
        command_ = arrived_;
        heard_ns_ = now_ns();
        is_new = has_command_ = true;
      }
      socket_.wait(schedule.due_ns());
    } while (now_ns() < schedule.due_ns());
    if (has_command_ && !is_new) ++report_.link.held;
    device.write(command_);
    ++report_.periods;
  }
}

void Server::live_in_lock_step(device::Device& device, const std::atomic<bool>& stop) {
  while (true) {
    device.read(frame_);
    frame_ns_ = sent_ns_[frame_.sequence % kRemembered] = now_ns();
    send(frame_);
    if (!answered(stop)) return;
    device.write(arrived_);
    ++report_.periods;
  }
}

// waits for the command that answers the frame; false: the session is over
bool Server::answered(const std::atomic<bool>& stop) {
  const std::int64_t deadline = now_ns() + ns(config_.lock_step_timeout_s);
  while (!stop.load()) {
    const Event event = receive();
    const bool is_answer = event == Event::kCommand && arrived_.sequence == frame_.sequence;
    if (is_answer) {
      measure_answer();
      return true;
    }
    if (event == Event::kGoodbye) return false;
    // the client has missed the frame
    if (event == Event::kReady ||
        (event == Event::kCommand && arrived_.sequence < frame_.sequence)) {
      send(frame_);
      ++report_.link.repeated;
    }
    if (now_ns() >= deadline) return false;
    if (event == Event::kNone) socket_.wait(std::min(deadline, now_ns() + kLook));
  }
  return false;
}

DeviceServer::DeviceServer(const Address& address, const ServerConfig& config)
    : server_(std::make_unique<Server>(address, config)) {}
DeviceServer::~DeviceServer() = default;
std::string DeviceServer::address() const { return server_->address(); }
std::string DeviceServer::capture_error() { return server_->capture_error(); }
bool DeviceServer::wait_for_client(const std::atomic<bool>& stop) {
  return server_->wait_for_client(stop);
}
SessionReport DeviceServer::serve(device::Device& device, const std::atomic<bool>& stop) {
  return server_->serve(device, stop);
}

}  // namespace hg::udp
