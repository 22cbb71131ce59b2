#include "hg/device/udp/device_server.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hg/core/schedule.h"
#include "hg/device/udp/agreement.h"
#include "hg/device/udp/round_trip.h"
#include "hg/device/udp/session_host.h"

namespace hg::udp {
namespace {

constexpr std::int64_t kLook = 100'000'000;             // ns, between two checks whether to stop
constexpr std::int64_t kFirstPatience = 1'000'000'000;  // ns, with the drives off
constexpr std::int64_t kReportPeriod = 100'000'000;     // ns, of round trips
constexpr std::size_t kRemembered = 2048;               // frames whose answers are timed

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

HostConfig host_of(const ServerConfig& config) {
  return {.actual = config.actual,
          .server = config.server,
          .is_simulated = config.is_simulated,
          .silence_s =
              config.actual.is_lock_step ? config.lock_step_timeout_s : config.command_timeout_s,
          .ready_timeout_s = config.ready_timeout_s,
          .capture = config.capture,
          .key = config.key};
}

}  // namespace

/// What DeviceServer does, with its session and what it knows of its client.
class Server {
 public:
  Server(const Address& address, const ServerConfig& config)
      : config_(config), host_(address, host_of(config)) {}

  // as DeviceServer
  std::string address() const { return host_.address(); }
  std::string capture_error() { return host_.capture_error(); }
  bool wait_for_client(const std::atomic<bool>& stop);
  SessionReport serve(device::Device& device, const std::atomic<bool>& stop);

 private:
  enum class Event { kNone, kReady, kCommand, kGoodbye };
  Event receive();
  Event take(const Header& header);
  void live_in_real_time(device::Device& device, const std::atomic<bool>& stop);
  void live_in_lock_step(device::Device& device, const std::atomic<bool>& stop);
  void close_session(bool is_stopped);
  bool answered(const std::atomic<bool>& stop);
  void measure_answer();
  void report_round_trip();

  ServerConfig config_;
  SessionHost host_;
  SensorFrame frame_;
  CommandFrame arrived_, command_;  ///< `command_` is in effect
  bool has_command_ = false;        ///< a command has arrived in this session
  bool has_left_ = false;           ///< the client has sent a goodbye
  std::int64_t frame_ns_ = 0, heard_ns_ = 0;
  std::array<std::int64_t, kRemembered> sent_ns_{};  ///< of the newest frames, by their sequence
  std::int64_t answers_ = 0, answers_ns_ = 0, longest_answer_ns_ = 0;
  std::int64_t reported_ = 0, reported_ns_ = 0,
               due_report_ns_ = 0;  ///< answers that the client knows, and when more are due
  std::uint64_t late_ = 0;
  SessionReport report_;
};

// receives one datagram, if any waits
Server::Event Server::receive() {
  Header header;
  return host_.hear(header) == Heard::kMessage ? take(header) : Event::kNone;
}

Server::Event Server::take(const Header& header) {
  switch (static_cast<MessageType>(header.type)) {
    case MessageType::kReady:
      return Event::kReady;
    case MessageType::kCommand:
      if (!host_.take(arrived_)) return Event::kNone;
      if (!fits(config_.actual, arrived_) ||
          arrived_.sequence > frame_.sequence) {  // answers a frame that was never sent
        host_.count_malformed();
        return Event::kNone;
      }
      return Event::kCommand;
    case MessageType::kGoodbye: {
      Goodbye goodbye;
      if (host_.take(goodbye)) report_.farewell = goodbye.reason.printable();
      has_left_ = true;
      return Event::kGoodbye;
    }
    case MessageType::kHello:
    case MessageType::kWelcome:
    case MessageType::kSensors:
    case MessageType::kRoundTrip:
    case MessageType::kTerms:
    case MessageType::kLeader:
    case MessageType::kRemote:
      break;
  }
  host_.count_foreign();
  return Event::kNone;
}

bool Server::wait_for_client(const std::atomic<bool>& stop) {
  host_.end_session();
  while (!stop.load()) {
    if (receive() == Event::kReady) return true;
    host_.forget_late_candidates();
    host_.wait(now_ns() + kLook);
  }
  return false;
}

SessionReport Server::serve(device::Device& device, const std::atomic<bool>& stop) {
  report_ = {};
  report_.client = host_.client();
  answers_ = answers_ns_ = longest_answer_ns_ = reported_ = reported_ns_ = due_report_ns_ = 0;
  late_ = 0;
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
  report_.other = host_.first_other();
  if (has_left_) {
    host_.end_session();
  } else {
    host_.leave({is_silent ? Farewell::kSilent : Farewell::kDone,
                 is_silent ? "no command came in time: drives off, brakes closed"
                           : "the server was stopped"});
  }
  report_.end = has_left_   ? SessionEnd::kClientLeft
                : is_silent ? SessionEnd::kClientSilent
                            : SessionEnd::kStopped;
  if (answers_ > 0) {
    report_.mean_answer_s = 1e-9 * static_cast<double>(answers_ns_) / static_cast<double>(answers_);
  }
  report_.max_answer_s = 1e-9 * static_cast<double>(longest_answer_ns_);
  const std::uint64_t held = report_.link.held, repeated = report_.link.repeated;
  report_.link = host_.counts();
  report_.link.held = held;
  report_.link.repeated = repeated;
  report_.link.late = late_;
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
  host_.send(RoundTrip{1e-9 * static_cast<double>(answers_ns_ - reported_ns_) /
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
    host_.send(frame_);
    report_round_trip();
    report_.overruns += schedule.advance(frame_ns_);
    bool is_new = false;
    do {
      for (Event event = receive(); event != Event::kNone; event = receive()) {
        if (event == Event::kGoodbye) return;
        if (event != Event::kCommand) continue;
        measure_answer();
        if (host_.was_overtaken() || arrived_.sequence + most_periods < frame_.sequence) {
          ++late_;
          continue;
        }
        command_ = arrived_;
        heard_ns_ = now_ns();
        is_new = has_command_ = true;
      }
      host_.wait(schedule.due_ns());
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
    host_.send(frame_);
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
      host_.send(frame_);
      ++report_.link.repeated;
    }
    if (now_ns() >= deadline) return false;
    if (event == Event::kNone) host_.wait(std::min(deadline, now_ns() + kLook));
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
