#include "hg/remote/device_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hg/remote/agreement.h"
#include "hg/runtime/schedule.h"

namespace hg::remote {
namespace {

constexpr std::int64_t kLook = 100'000'000;  // ns, between two looks whether to stop
constexpr int kGoodbyes = 3;                 // nobody answers them: one may be lost

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

}  // namespace

DeviceServer::DeviceServer(const Address& address, const ServerConfig& config)
    : config_(config), socket_(UdpSocket::listening_at(address)) {
  if (!config.capture.empty()) capture_ = std::make_unique<Capture>(config.capture);
}

template <typename Message>
void DeviceServer::send(const Message& message) {
  const std::span<const std::byte> datagram = outbox_.encode(message);
  socket_.send(datagram, client_);
  if (capture_) capture_->add(now_ns(), datagram);
}

// one datagram, if any waits
DeviceServer::Event DeviceServer::receive() {
  Peer from;
  if (!socket_.receive(datagram_, from)) return Event::kNone;
  if (capture_) capture_->add(now_ns(), datagram_.view());
  Header header;
  const Verdict verdict = read_header(datagram_.view(), header);
  const bool is_whole = verdict == Verdict::kGood || verdict == Verdict::kWrongVersion;
  if (is_whole && header.type == static_cast<std::uint16_t>(MessageType::kHello)) {
    on_hello(header, verdict, from);
    return Event::kNone;
  }
  // a session begins with a hello, and what is left of an old one is not for the next
  return has_client_ && inbox_.accept(verdict, header) ? take(header) : Event::kNone;
}

DeviceServer::Event DeviceServer::take(const Header& header) {
  switch (static_cast<MessageType>(header.type)) {
    case MessageType::kReady:
      return Event::kReady;
    case MessageType::kCommand:
      if (!decode(datagram_.view(), arrived_) || !fits(config_.actual, arrived_)) {
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
      break;
  }
  ++foreign_;
  return Event::kNone;
}

void DeviceServer::on_hello(const Header& header, Verdict verdict, const Peer& from) {
  if (verdict == Verdict::kWrongVersion) {
    refuse(Refusal::kProtocol,
           fmt::format("protocol: version {}, expected {}", kVersion, header.version), 0, from);
    return;
  }
  Hello hello;
  if (!decode(datagram_.view(), hello)) {
    ++malformed_;
    return;
  }
  if (has_client_ && !(from == client_ && hello.nonce == hello_.nonce)) {
    refuse(Refusal::kBusy,
           fmt::format("{} at {} has the device", hello_.client.printable(), to_string(client_)),
           hello.nonce, from);
    return;
  }
  const std::string unlike = difference(config_.actual, hello.expected);
  if (!unlike.empty()) {
    refuse(Refusal::kMismatch, unlike, hello.nonce, from);
    return;
  }
  if (!has_client_) {
    std::random_device random;
    const std::uint32_t session = random() | 1U;  // never 0
    outbox_ = Outbox(session);
    inbox_ = Inbox(session);
    has_client_ = true;
    client_ = from;
    hello_ = hello;
  }
  send(Welcome{.nonce = hello.nonce,
               .actual = config_.actual,
               .command_timeout_s = config_.actual.is_lock_step ? config_.lock_step_timeout_s
                                                                : config_.command_timeout_s,
               .server = config_.server});
}

void DeviceServer::refuse(Refusal refusal, const std::string& reason, std::uint64_t nonce,
                          const Peer& to) {
  ++refused_;
  Outbox outbox(0);
  const auto datagram = outbox.encode(Welcome{.nonce = nonce,
                                              .refusal = refusal,
                                              .actual = config_.actual,
                                              .server = config_.server,
                                              .reason = reason});
  socket_.send(datagram, to);
  if (capture_) capture_->add(now_ns(), datagram);
}

bool DeviceServer::wait_for_client(const std::atomic<bool>& stop) {
  has_client_ = false;
  std::int64_t give_up_ns = 0;
  while (!stop.load()) {
    const bool had_client = has_client_;
    const Event event = receive();
    if (event == Event::kReady) return true;
    if (has_client_ && !had_client) give_up_ns = now_ns() + ns(config_.ready_timeout_s);
    const bool is_over = event == Event::kGoodbye || now_ns() > give_up_ns;
    if (has_client_ && is_over) has_client_ = false;
    socket_.wait(now_ns() + kLook);
  }
  return false;
}

SessionReport DeviceServer::serve(device::Device& device, const std::atomic<bool>& stop) {
  report_ = {};
  report_.client = fmt::format("{} at {}", hello_.client.printable(), to_string(client_));
  answers_ = answers_ns_ = longest_answer_ns_ = 0;
  refused_ = late_ = malformed_ = foreign_ = 0;
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

void DeviceServer::close_session(bool is_stopped) {
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
  has_client_ = false;
}

void DeviceServer::measure_answer() {
  const std::int64_t time = now_ns() - frame_ns_;
  ++answers_;
  answers_ns_ += time;
  longest_answer_ns_ = std::max(longest_answer_ns_, time);
}

void DeviceServer::live_in_real_time(device::Device& device, const std::atomic<bool>& stop) {
  runtime::Schedule schedule(now_ns(), std::llround(1e9 / config_.actual.rate_Hz));
  const std::int64_t timeout = ns(config_.command_timeout_s);
  // the age of the frame that a command answers: a client that falls behind is not to be followed
  const auto most_periods =
      static_cast<std::uint64_t>(config_.command_timeout_s * config_.actual.rate_Hz);
  while (!stop.load() && now_ns() - heard_ns_ <= timeout) {
    device.read(frame_);
    frame_ns_ = now_ns();
    send(frame_);
    report_.overruns += schedule.advance(frame_ns_);
    bool is_new = false;
    do {
      for (Event event = receive(); event != Event::kNone; event = receive()) {
        if (event == Event::kGoodbye) return;
        if (event != Event::kCommand) continue;
        if (inbox_.was_overtaken() || arrived_.sequence + most_periods < frame_.sequence) {
          ++late_;
          continue;
        }
        command_ = arrived_;
        heard_ns_ = now_ns();
        is_new = has_command_ = true;
        if (command_.sequence == frame_.sequence) measure_answer();
      }
      socket_.wait(schedule.due_ns());
    } while (now_ns() < schedule.due_ns());
    if (has_command_ && !is_new) ++report_.link.held;
    device.write(command_);
    ++report_.periods;
  }
}

void DeviceServer::live_in_lock_step(device::Device& device, const std::atomic<bool>& stop) {
  while (true) {
    device.read(frame_);
    frame_ns_ = now_ns();
    send(frame_);
    if (!answered(stop)) return;
    device.write(arrived_);
    ++report_.periods;
  }
}

// waits for the command that answers the frame; false: the session is over
bool DeviceServer::answered(const std::atomic<bool>& stop) {
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

}  // namespace hg::remote
