#include "hg/device/udp/remote_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "hg/core/error.h"
#include "hg/device/udp/agreement.h"
#include "hg/device/udp/arrivals.h"
#include "hg/device/udp/frame_queue.h"
#include "hg/device/udp/inbox.h"
#include "hg/device/udp/outbox.h"
#include "hg/device/udp/round_trip.h"
#include "hg/device/udp/udp_socket.h"

namespace hg::udp {
namespace {

constexpr std::int64_t kHelloPeriod = 100'000'000;  // ns
constexpr std::int64_t kRepeatPeriod = 20'000'000;  // ns, in lock-step and for the first frame
constexpr int kMostAtOnce = 64;                     // datagrams
constexpr int kGoodbyes = 3;                        // not acknowledged: one may be lost

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

std::uint64_t random_number() {
  std::random_device random;
  return std::uint64_t{random()} << 32U | random();
}

// a device that left because of silence has lost our commands
FaultCode reason_of(const Goodbye& goodbye) noexcept {
  return goodbye.farewell == Farewell::kSilent ? FaultCode::kCommandsLost : FaultCode::kDeviceGone;
}

}  // namespace

/// What RemoteDevice does, with the socket and what it has received.
class Client {
 public:
  Client(const Address& address, const ClientConfig& config);
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { close(fault_); }

  // as RemoteDevice
  void read(SensorFrame& sensors) noexcept;
  void write(const CommandFrame& command) noexcept;
  void close(FaultCode reason) noexcept;
  const Welcome& welcome() const noexcept { return welcome_; }
  std::string farewell() const { return goodbye_.reason.printable(); }
  LinkCounts counts() const noexcept;
  std::int64_t late_ns() const noexcept { return late_ns_; }
  double round_trip_s() const noexcept { return round_trip_s_.load(std::memory_order_relaxed); }

 private:
  void connect(const std::string& at);
  bool answers(const std::string& at, std::uint64_t nonce, bool is_patient);
  void take_in() noexcept;
  void take(const Header& header) noexcept;
  void say_again() noexcept;
  void stop(FaultCode fault, SensorFrame& sensors) noexcept;
  template <typename Message>
  void send(const Message& message) noexcept {
    socket_.send(outbox_.encode(message));
  }

  ClientConfig config_;
  UdpSocket socket_;
  Outbox outbox_;
  Inbox inbox_{0};
  FrameQueue queue_;
  Arrivals arrivals_;
  Welcome welcome_;
  Goodbye goodbye_;
  SensorFrame arrived_;
  CommandFrame last_command_;
  std::uint64_t newest_ = 0;  ///< number of the newest frame received
  Datagram datagram_;
  bool is_started_ = false;  ///< the first frame has arrived
  std::int64_t started_ns_ = 0;
  bool has_command_ = false;
  bool has_left_ = false;  ///< the server has left
  bool is_closed_ = false;
  FaultCode fault_ = FaultCode::kNone;
  LinkCounts own_;               ///< counts beyond those of inbox and queue
  std::int64_t arrived_ns_ = 0;  ///< of the first frame that this read() has received; 0: none
  std::int64_t late_ns_ = 0;     ///< of this computer in this read()
  std::atomic<double> round_trip_s_{std::numeric_limits<double>::quiet_NaN()};
};

Client::Client(const Address& address, const ClientConfig& config)
    : config_(config),
      socket_(UdpSocket::talking_to(address)),
      outbox_(0, config.key),
      arrivals_(config.expected.rate_Hz) {
  connect(address.host + ":" + address.port);
}

void Client::connect(const std::string& at) {
  const std::uint64_t nonce = random_number();
  const std::int64_t busy_until = now_ns() + ns(config_.busy_patience_s);
  const std::int64_t deadline = now_ns() + ns(config_.answer_timeout_s + config_.busy_patience_s);
  while (now_ns() < deadline) {
    send(Hello{nonce, config_.expected, config_.client});
    const std::int64_t again = std::min(now_ns() + kHelloPeriod, deadline);
    while (now_ns() < again) {
      socket_.wait(again);
      if (answers(at, nonce, now_ns() < busy_until)) return;
      if (socket_.was_refused()) break;  // port closed: try again later
    }
    while (now_ns() < again) socket_.wait(again);
  }
  throw SetupError(
      fmt::format("{}: no device answers there within {:g} s; is its server running "
                  "(hapticgiant simulate --listen {})?",
                  at, config_.answer_timeout_s, at));
}

// whether a datagram was the welcome
bool Client::answers(const std::string& at, std::uint64_t nonce, bool is_patient) {
  Peer from;
  if (!socket_.receive(datagram_, from)) return false;
  Header header;
  const DatagramCheck verdict = read_header(datagram_.view(), header, config_.key);
  if (verdict == DatagramCheck::kWrongVersion) {
    throw SetupError(
        fmt::format("{}: the device speaks version {} of the protocol, this program {}", at,
                    header.version, kVersion));
  }
  // a server with another key or none can report just that
  const bool is_forged = verdict == DatagramCheck::kForged;
  if (!(verdict == DatagramCheck::kGood || is_forged) ||
      header.type != static_cast<std::uint16_t>(MessageType::kWelcome)) {
    return false;
  }
  if (!decode(datagram_.view(), welcome_) || welcome_.nonce != nonce) return false;
  if (is_forged && welcome_.refusal == ConnectionRefusal::kNone) {
    throw SetupError(at + ": the device's answer is not of the key that was given (--key-file)");
  }
  if (welcome_.refusal == ConnectionRefusal::kBusy && is_patient) return false;  // busy: try again
  if (welcome_.refusal != ConnectionRefusal::kNone) {
    throw SetupError(fmt::format("{}: the device refuses: {}", at, welcome_.reason.printable()));
  }
  const std::string unlike = difference(welcome_.actual, config_.expected);
  if (!unlike.empty()) {
    throw SetupError(fmt::format("{}: the device does not fit: {}", at, unlike));
  }
  outbox_.join(header.session);
  inbox_ = Inbox(header.session);
  return inbox_.accept(verdict, header);
}

void Client::read(SensorFrame& sensors) noexcept {
  arrived_ns_ = late_ns_ = 0;
  if (fault_ != FaultCode::kNone) return stop(fault_, sensors);
  const bool is_lock_step = config_.expected.is_lock_step;
  const double timeout_s = !is_started_   ? config_.first_timeout_s
                           : is_lock_step ? config_.lock_step_timeout_s
                                          : config_.frame_timeout_s;
  const std::int64_t begin = now_ns();
  std::int64_t deadline = begin + ns(timeout_s);
  // a long way is no silence, and may be waited for while nothing can move
  if (is_started_ && !last_command_.enable && !is_lock_step) {
    deadline = std::max(deadline, started_ns_ + ns(config_.first_timeout_s));
  }
  std::int64_t again = is_started_ ? begin + kRepeatPeriod : begin;
  while (true) {
    take_in();
    if (queue_.pop(sensors)) {
      if (!std::exchange(is_started_, true)) started_ns_ = now_ns();
      newest_ = sensors.sequence;
      late_ns_ = now_ns() - std::max(begin, arrived_ns_);
      return;
    }
    if (has_left_) return stop(reason_of(goodbye_), sensors);
    const std::int64_t now = now_ns();
    if (now >= deadline) return stop(FaultCode::kDeviceSilent, sensors);
    const bool says_again = is_lock_step || !is_started_;
    if (says_again && now >= again) {
      say_again();
      again = now + kRepeatPeriod;
    }
    socket_.wait(says_again ? std::min(again, deadline) : deadline);
  }
}

void Client::take_in() noexcept {
  Peer from;
  for (int i = 0; i < kMostAtOnce; ++i) {
    if (queue_.is_full() || !socket_.receive(datagram_, from)) return;
    Header header;
    const DatagramCheck verdict = read_header(datagram_.view(), header, config_.key);
    if (inbox_.accept(verdict, header)) take(header);
  }
}

void Client::take(const Header& header) noexcept {
  switch (static_cast<MessageType>(header.type)) {
    case MessageType::kSensors:
      if (!decode(datagram_.view(), arrived_) || !fits(config_.expected, arrived_)) {
        ++own_.malformed;
      } else if (!queue_.push(arrived_)) {
        ++own_.late;
      } else {
        if (arrived_ns_ == 0) arrived_ns_ = socket_.arrived_ns();
        const bool is_late = arrivals_.is_late(arrived_.sequence, socket_.arrived_ns());
        if (is_late && !config_.expected.is_lock_step) ++own_.late;
      }
      return;
    case MessageType::kGoodbye:
      if (!decode(datagram_.view(), goodbye_)) ++own_.malformed;
      has_left_ = true;
      return;
    case MessageType::kRoundTrip: {
      RoundTrip trip;
      const bool is_good = decode(datagram_.view(), trip) && trip.mean_s >= 0.0;
      if (is_good && std::isfinite(trip.mean_s)) {
        round_trip_s_.store(trip.mean_s, std::memory_order_relaxed);
      } else {
        ++own_.malformed;
      }
      return;
    }
    case MessageType::kWelcome:  // answer to a hello that was sent twice
      return;
    case MessageType::kHello:
    case MessageType::kReady:
    case MessageType::kCommand:
      ++own_.foreign;
      return;
  }
}

// repeats what was lost: the server waits for it
void Client::say_again() noexcept {
  if (has_command_) {
    send(last_command_);
    ++own_.repeated;
  } else {
    send(Ready{});
  }
}

void Client::stop(FaultCode fault, SensorFrame& sensors) noexcept {
  fault_ = fault;
  if (!is_started_) {
    const auto n_m = static_cast<Eigen::Index>(config_.expected.n_m);
    sensors.q_m = sensors.dq_m = sensors.theta_m = sensors.tau_m = VectorM::Zero(n_m);
    sensors.q_p = VectorP::Zero(config_.expected.n_p);
  }
  ++sensors.sequence;
  sensors.driver_fault = fault;
}

void Client::write(const CommandFrame& command) noexcept {
  // in lock-step a frame has one answer; the command at the end is followed by a goodbye
  const bool is_answered = has_command_ && command.sequence == last_command_.sequence;
  if (config_.expected.is_lock_step && is_answered) return;
  last_command_ = command;
  // after a fault, frames are generated locally: the server accepts no answer to an unsent frame
  last_command_.sequence = std::min(command.sequence, newest_);
  has_command_ = true;
  send(last_command_);
}

void Client::close(FaultCode reason) noexcept {
  if (is_closed_ || has_left_) return;
  is_closed_ = true;
  const bool is_fault = reason != FaultCode::kNone;
  const Goodbye goodbye{is_fault ? Farewell::kFault : Farewell::kDone,
                        is_fault ? to_string(reason) : "done"};
  for (int i = 0; i < kGoodbyes; ++i) send(goodbye);
}

LinkCounts Client::counts() const noexcept {
  LinkCounts counts = inbox_.counts();
  counts.sent = outbox_.number();
  counts.held = queue_.held();
  counts.late = own_.late;
  counts.repeated = own_.repeated;
  counts.malformed = own_.malformed;
  counts.foreign += own_.foreign;
  return counts;
}

RemoteDevice::RemoteDevice(const Address& address, const ClientConfig& config)
    : client_(std::make_unique<Client>(address, config)) {}
RemoteDevice::~RemoteDevice() = default;
void RemoteDevice::read(SensorFrame& sensors) noexcept { client_->read(sensors); }
void RemoteDevice::write(const CommandFrame& command) noexcept { client_->write(command); }
void RemoteDevice::close(FaultCode reason) noexcept { client_->close(reason); }
const Welcome& RemoteDevice::welcome() const noexcept { return client_->welcome(); }
std::string RemoteDevice::farewell() const { return client_->farewell(); }
LinkCounts RemoteDevice::counts() const noexcept { return client_->counts(); }
std::int64_t RemoteDevice::late_ns() const noexcept { return client_->late_ns(); }
double RemoteDevice::round_trip_s() const noexcept { return client_->round_trip_s(); }

}  // namespace hg::udp
