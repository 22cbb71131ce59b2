/// Clients and servers for tests of the other side, over 127.0.0.1.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "hg/core/error.h"
#include "hg/device/udp/agreement.h"
#include "hg/device/udp/device_server.h"
#include "hg/device/udp/remote_device.h"
#include "hg/device/udp/udp_socket.h"

namespace hg::udp {

inline constexpr double kLong = 60.0;  // s; only a broken test waits for so long

inline Description description(bool is_lock_step) {
  return {.device = "test device",
          .n_p = 1,
          .n_m = 6,
          .rate_Hz = 200.0,
          .interface = Interface::kTorque,
          .is_lock_step = is_lock_step};
}

/// Its measurements depend on every command that it has received.
class TestDevice final : public device::Device {
 public:
  explicit TestDevice(std::uint64_t first_sequence = 0) {
    frame_.sequence = first_sequence;
    frame_.q_m = frame_.dq_m = frame_.theta_m = frame_.tau_m = VectorM::Zero(6);
    frame_.q_p = VectorP::Zero(1);
  }
  void read(SensorFrame& sensors) noexcept override { sensors = frame_; }
  void write(const CommandFrame& command) noexcept override {
    last = command;
    if (command.enable) was_enabled = true;
    ++frame_.sequence;
    frame_.time_s = 5e-3 * static_cast<double>(frame_.sequence);
    frame_.q_m = 0.9 * frame_.q_m + 0.1 * command.tau_m;
    frame_.q_p += 5e-3 * command.dq_p;
    frame_.answered_sequence = command.sequence;
  }

  CommandFrame last;
  bool was_enabled = false;

 private:
  SensorFrame frame_;
};

/// A controller whose command depends on everything it measured
inline CommandFrame answer(const SensorFrame& sensors) {
  CommandFrame command = off_command(description(true));
  command.sequence = sensors.sequence;
  command.enable = true;
  command.tau_m = VectorM::Constant(6, 1.0) - 0.5 * sensors.q_m;
  command.tau_m[0] += 0.01 * static_cast<double>(sensors.sequence % 7);
  command.dq_p = -sensors.q_p + VectorP::Constant(1, 0.3);
  return command;
}

/// A server with its device in a thread of its own.
class Serving {
 public:
  explicit Serving(bool is_lock_step, double command_timeout_s = kLong,
                   std::uint64_t first_sequence = 0, const Key& key = {})
      : server_({"127.0.0.1", "0"}, {.actual = description(is_lock_step),
                                     .server = "test server",
                                     .command_timeout_s = command_timeout_s,
                                     .lock_step_timeout_s = command_timeout_s,
                                     .key = key}),
        thread_([this, first_sequence] {
          while (server_.wait_for_client(stop_)) {
            TestDevice device(first_sequence);
            reports.push_back(server_.serve(device, stop_));
            was_enabled = device.was_enabled;
            ends_off = !device.last.enable;
            sessions.fetch_add(1);
          }
        }) {}
  ~Serving() { stop(); }

  Address address() const { return parse_address("test", server_.address()); }
  void stop() {
    stop_.store(true);
    if (thread_.joinable()) thread_.join();
  }
  void await_sessions(int count) const {
    while (sessions.load() < count) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  std::vector<SessionReport> reports;  // after stop() or await_sessions()
  bool was_enabled = false, ends_off = false;
  std::atomic<int> sessions{0};

 private:
  std::atomic<bool> stop_{false};
  DeviceServer server_;
  std::thread thread_;
};

inline ClientConfig client(bool is_lock_step, const Key& key = {}) {
  return {.expected = description(is_lock_step),
          .client = "test client",
          .answer_timeout_s = kLong,
          .first_timeout_s = kLong,
          .frame_timeout_s = kLong,
          .lock_step_timeout_s = kLong,
          .key = key};
}

inline std::string message_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// A server that speaks the protocol as far as a test wants
class Script {
 public:
  Script() : socket_(UdpSocket::listening_at({"127.0.0.1", "0"})) {}
  Address address() const { return parse_address("test", to_string(socket_.own_address())); }
  Header await(MessageType type) {
    Header header;
    do {
      socket_.wait(now_ns() + 1'000'000'000);
    } while (!socket_.receive(datagram, client_) ||
             read_header(datagram.view(), header) != DatagramCheck::kGood ||
             header.type != static_cast<std::uint16_t>(type));
    return header;
  }
  /// Whatever it is.
  void await_any(Header& header) {
    while (!socket_.receive(datagram, client_)) socket_.wait(now_ns() + 1'000'000'000);
    (void)read_header(datagram.view(), header);
  }
  template <typename Message>
  void send(const Message& message, const Header& header) {
    Datagram out;
    encode(header, message, out);
    socket_.send(out.view(), client_);
  }
  void send_raw(std::span<const std::byte> bytes) { socket_.send(bytes, client_); }
  void welcome(const Description& actual) {
    await(MessageType::kHello);
    Hello hello;
    (void)decode(datagram.view(), hello);
    send(Welcome{.nonce = hello.nonce, .actual = actual}, {.session = 7, .number = 1});
  }
  Datagram datagram;

 private:
  UdpSocket socket_;
  Peer client_;
};

/// A client that says what a test wants
class Voice {
 public:
  Voice(const Address& server, std::uint64_t nonce, const Key& key = {})
      : socket_(UdpSocket::talking_to(server)), nonce_(nonce), key_(key) {}
  template <typename Message>
  void send(const Message& message, const Header& header) {
    encode(header, message, out_, key_);
    socket_.send(out_.view());
  }
  template <typename Message>
  void send_without_tag(const Message& message, const Header& header) {
    encode(header, message, out_);
    socket_.send(out_.view());
  }
  template <typename Message>
  void send(const Message& message) {
    send(message, {.session = session, .number = ++number_});
  }
  template <typename Message>
  Message await() {
    Message message;
    Header header;
    Peer from;
    while (!socket_.receive(in_, from) ||
           read_header(in_.view(), header, key_) != DatagramCheck::kGood ||
           header.type != static_cast<std::uint16_t>(kTypeOf<Message>) ||
           !decode(in_.view(), message)) {
      socket_.wait(now_ns() + 1'000'000'000);
    }
    session = header.session;
    return message;
  }
  /// Says that it is ready until the first frame comes. False: none came in ten seconds.
  bool begins() {
    const std::int64_t deadline = now_ns() + 10'000'000'000;
    std::int64_t again = 0;
    Header header;
    Peer from;
    while (now_ns() < deadline) {
      if (now_ns() >= again) {
        send(Ready{});
        again = now_ns() + 20'000'000;
      }
      while (socket_.receive(in_, from)) {
        const bool is_good = read_header(in_.view(), header, key_) == DatagramCheck::kGood;
        if (is_good && header.type == static_cast<std::uint16_t>(MessageType::kSensors))
          return true;
      }
      socket_.wait(again);
    }
    return false;
  }
  Welcome hello(bool is_lock_step, const char* name = "voice") {
    send(Hello{.nonce = nonce_, .expected = description(is_lock_step), .client = name}, {});
    return await<Welcome>();
  }
  std::uint32_t session = 0;

 private:
  UdpSocket socket_;
  std::uint64_t nonce_, number_ = 1;
  Key key_;
  Datagram in_, out_;
};

inline CommandFrame command_for(std::uint64_t sequence) {
  SensorFrame sensors;
  sensors.sequence = sequence;
  sensors.q_m = VectorM::Zero(6);
  sensors.q_p = VectorP::Zero(1);
  return answer(sensors);
}

}  // namespace hg::udp
