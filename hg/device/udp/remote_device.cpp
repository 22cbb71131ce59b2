#include "hg/device/udp/remote_device.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "hg/device/udp/agreement.h"
#include "hg/device/udp/arrivals.h"
#include "hg/device/udp/frame_queue.h"
#include "hg/device/udp/round_trip.h"
#include "hg/device/udp/session_guest.h"

namespace hg::udp {
namespace {

constexpr std::int64_t kRepeatPeriod = 20'000'000;  // ns, in lock-step and for the first frame
constexpr int kMostAtOnce = 64;                     // datagrams

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

// a device that left because of silence has lost our commands
FaultCode reason_of(const Goodbye& goodbye) noexcept {
  return goodbye.farewell == Farewell::kSilent ? FaultCode::kCommandsLost : FaultCode::kDeviceGone;
}

GuestConfig guest_of(const ClientConfig& config) {
  return {.expected = config.expected,
          .command = "hapticgiant simulate --listen",
          .client = config.client,
          .answer_timeout_s = config.answer_timeout_s,
          .busy_patience_s = config.busy_patience_s,
          .key = config.key};
}

}  // namespace

/// What RemoteDevice does, with its session and what it has received.
class Client {
 public:
  Client(const Address& address, const ClientConfig& config)
      : config_(config), guest_(address, guest_of(config)), arrivals_(config.expected.rate_Hz) {}
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client() { close(fault_); }

  // as RemoteDevice
  void read(SensorFrame& sensors) noexcept;
  void write(const CommandFrame& command) noexcept;
  void close(FaultCode reason) noexcept;
  const Welcome& welcome() const noexcept { return guest_.welcome(); }
  std::string farewell() const { return goodbye_.reason.printable(); }
  LinkCounts counts() const noexcept;
  std::int64_t late_ns() const noexcept { return late_ns_; }
  double round_trip_s() const noexcept { return round_trip_s_.load(std::memory_order_relaxed); }

 private:
  void take_in() noexcept;
  void take(const Header& header) noexcept;
  void say_again() noexcept;
  void stop(FaultCode fault, SensorFrame& sensors) noexcept;

  ClientConfig config_;
  SessionGuest guest_;
  FrameQueue queue_;
  Arrivals arrivals_;
  Goodbye goodbye_;
  SensorFrame arrived_;
  CommandFrame last_command_;
  std::uint64_t newest_ = 0;  ///< number of the newest frame received
  bool is_started_ = false;   ///< the first frame has arrived
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
    guest_.wait(says_again ? std::min(again, deadline) : deadline);
  }
}

void Client::take_in() noexcept {
  for (int i = 0; i < kMostAtOnce; ++i) {
    Header header;
    const Heard heard = queue_.is_full() ? Heard::kNothing : guest_.hear(header);
    if (heard == Heard::kNothing) return;
    if (heard == Heard::kMessage) take(header);
  }
}

void Client::take(const Header& header) noexcept {
  switch (static_cast<MessageType>(header.type)) {
    case MessageType::kSensors:
      if (!guest_.take(arrived_)) return;
      if (!fits(config_.expected, arrived_)) {
        guest_.count_malformed();
      } else if (!queue_.push(arrived_)) {
        ++own_.late;
      } else {
        if (arrived_ns_ == 0) arrived_ns_ = guest_.arrived_ns();
        const bool is_late = arrivals_.is_late(arrived_.sequence, guest_.arrived_ns());
        if (is_late && !config_.expected.is_lock_step) ++own_.late;
      }
      return;
    case MessageType::kGoodbye:
      if (!guest_.take(goodbye_)) goodbye_ = {};
      has_left_ = true;
      return;
    case MessageType::kRoundTrip: {
      RoundTrip trip;
      if (!guest_.take(trip)) return;
      if (trip.mean_s >= 0.0 && std::isfinite(trip.mean_s)) {
        round_trip_s_.store(trip.mean_s, std::memory_order_relaxed);
      } else {
        guest_.count_malformed();
      }
      return;
    }
    case MessageType::kWelcome:  // answer to a hello that was sent twice
      return;
    case MessageType::kHello:
    case MessageType::kReady:
    case MessageType::kCommand:
    case MessageType::kTerms:
    case MessageType::kLeader:
    case MessageType::kRemote:
      guest_.count_foreign();
      return;
  }
}

// repeats what was lost: the server waits for it
void Client::say_again() noexcept {
  if (has_command_) {
    guest_.send(last_command_);
    ++own_.repeated;
  } else {
    guest_.send(Ready{});
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
  guest_.send(last_command_);
}

void Client::close(FaultCode reason) noexcept {
  if (is_closed_ || has_left_) return;
  is_closed_ = true;
  const bool is_fault = reason != FaultCode::kNone;
  const Goodbye goodbye{is_fault ? Farewell::kFault : Farewell::kDone,
                        is_fault ? to_string(reason) : "done"};
  guest_.leave(goodbye);
}

LinkCounts Client::counts() const noexcept {
  LinkCounts counts = guest_.counts();
  counts.held = queue_.held();
  counts.late = own_.late;
  counts.repeated = own_.repeated;
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
