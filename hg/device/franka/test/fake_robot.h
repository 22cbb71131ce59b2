/// A robot for tests of its client, over 127.0.0.1: it stands still and gives prepared answers.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "hg/device/franka/protocol.h"
#include "hg/device/udp/udp_socket.h"

namespace hg::franka {

/// What a robot does; may be changed while it runs.
struct Behaviour {
  std::uint16_t version = kVersion;
  bool accepts_any_version = false;
  bool answers = true;  ///< to Connect
  bool sends_states = true;
  bool sends_nonsense = false;  ///< a datagram that is no state before each state
  bool accepts_moves = true;
  bool recovers = true;
  bool yields = false;                ///< torques move it
  RobotMode mode = RobotMode::kIdle;  ///< at the beginning
  std::array<float, kJoints> tau_ext{};
  std::array<float, 6> K_F_ext = {0.25F, 0, 0, 0, 0, 0};
  float m_ee = 0.0F;
  float success_rate = 1.0F;  ///< that it reports while it moves
  /// Weight of a tool that it holds with z of its flange down, N per kg that it does not know of
  float weight_per_kg = 9.81F;
  float tool_kg = 0.35F;
};

class FakeRobot {
 public:
  explicit FakeRobot(const Behaviour& behaviour = {}) : behaviour_(behaviour) {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(listener_, reinterpret_cast<sockaddr*>(&own), sizeof own);
    listen(listener_, 4);
    socklen_t size = sizeof own;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&own), &size);
    port_ = ntohs(own.sin_port);
    thread_ = std::thread([this] { live(); });
  }
  ~FakeRobot() { stop(); }
  void stop() {
    stop_.store(true);
    if (thread_.joinable()) thread_.join();
    if (listener_ >= 0) close(listener_);
    listener_ = -1;
  }

  udp::Address address() const { return {"127.0.0.1", std::to_string(port_)}; }

  void set(const Behaviour& behaviour) {
    const std::lock_guard lock(mutex_);
    behaviour_ = behaviour;
  }
  /// From now on sends a state for each of these calls alone, so that none waits for a test that
  /// another program holds up.
  void send_one() { states_to_send_.store(std::max(states_to_send_.load(), 0) + 1); }
  /// Sends 1000 states per second again.
  void send_freely() { states_to_send_.store(-1); }
  /// The next states leave out as many numbers.
  void lose(std::uint64_t states) {
    const std::lock_guard lock(mutex_);
    id_ += states;
  }
  /// Stops the motion for this error.
  void reflex(int error) {
    const std::lock_guard lock(mutex_);
    state_.errors[error] = state_.reflex_reason[error] = 1;
    end_motion(MoveStatus::kReflexAborted, RobotMode::kReflex);
  }
  void press_user_stop(bool is_pressed) {
    const std::lock_guard lock(mutex_);
    if (is_pressed) {
      end_motion(MoveStatus::kEmergencyAborted, RobotMode::kUserStopped);
    } else {
      state_.robot_mode = RobotMode::kIdle;
    }
  }
  /// Closes the connection, as a robot that is switched off.
  void leave() {
    const std::lock_guard lock(mutex_);
    is_leaving_ = true;
  }

  std::atomic<int> commands{0};                                           ///< torques received
  std::atomic<int> motions{0}, recoveries{0}, connections{0}, newest{0};  ///< newest: state
  std::array<double, kJoints> last_torques() {
    const std::lock_guard lock(mutex_);
    return last_.tau_J_d;
  }
  LoadRequest load() {
    const std::lock_guard lock(mutex_);
    return load_;
  }
  CollisionRequest collision() {
    const std::lock_guard lock(mutex_);
    return collision_;
  }
  /// Largest change of a torque from one command to the next, Nm.
  double largest_step() {
    const std::lock_guard lock(mutex_);
    return largest_step_;
  }
  /// Largest acceleration and jerk of speeds, rad/s^2 and rad/s^3.
  double largest_acceleration() {
    const std::lock_guard lock(mutex_);
    return largest_acceleration_;
  }
  double largest_jerk() {
    const std::lock_guard lock(mutex_);
    return largest_jerk_;
  }
  double speed(int joint) {
    const std::lock_guard lock(mutex_);
    return state_.dq_d[joint];
  }
  bool is_moving() {
    const std::lock_guard lock(mutex_);
    return state_.robot_mode == RobotMode::kMove;
  }

  /// Posture of fci.yaml.
  static constexpr std::array<float, kJoints> kPosture = {0, 0.028F, 0, -2.091F, 0, 2.119F, 0};

 private:
  static bool is_ready(int file, int timeout_ms) {
    pollfd one{.fd = file, .events = POLLIN, .revents = 0};
    return poll(&one, 1, timeout_ms) > 0;
  }

  void live() {
    while (!stop_.load()) {
      if (!is_ready(listener_, 5)) continue;
      stream_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      ++connections;
      serve();
      close(stream_);
    }
  }

  void serve() {
    udp::UdpSocket socket = udp::UdpSocket::listening_at({"127.0.0.1", "0"});
    begin();
    while (!stop_.load()) {
      while (is_ready(stream_, 0)) {
        if (!hear()) return;
      }
      const std::lock_guard lock(mutex_);
      if (is_leaving_) return;
      take(socket);
      if (is_connected_ && behaviour_.sends_states) send_state(socket);
    }
  }

  void begin() {
    const std::lock_guard lock(mutex_);
    state_ = {};
    state_.robot_mode = behaviour_.mode;
    state_.controller_mode = 3;
    const std::array<float, 16> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    state_.T_F_ee = state_.T_ee_K = identity;
    state_.q = state_.q_d = kPosture;
    is_connected_ = is_leaving_ = false;
    id_ = 1;
  }

  bool hear() {
    CommandHeader header;
    std::array<std::byte, 1000> body;
    if (recv(stream_, &header, sizeof header, MSG_WAITALL) != sizeof header) return false;
    const std::size_t size = header.size - sizeof header;
    if (size > 0 && recv(stream_, body.data(), size, MSG_WAITALL) != static_cast<ssize_t>(size)) {
      return false;
    }
    const std::lock_guard lock(mutex_);
    act(header, std::span(body).first(size));
    return true;
  }

  void act(const CommandHeader& header, std::span<const std::byte> body) {
    std::uint8_t status = 0;
    switch (header.command) {
      case Command::kConnect:
        return connect(header, body);
      case Command::kMove:
        status = behaviour_.accepts_moves ? 1 : 5;
        std::memcpy(&move_, body.data(), sizeof move_);
        if (behaviour_.accepts_moves) begin_motion(header.id);
        break;
      case Command::kStopMove:
        end_motion(MoveStatus::kPreempted, RobotMode::kIdle);
        break;
      case Command::kSetCollisionBehavior:
        std::memcpy(&collision_, body.data(), sizeof collision_);
        break;
      case Command::kSetLoad:
        std::memcpy(&load_, body.data(), sizeof load_);
        state_.m_load = static_cast<float>(load_.mass);
        break;
      case Command::kAutomaticErrorRecovery:
        ++recoveries;
        status = behaviour_.recovers ? 0 : 3;
        if (!behaviour_.recovers) break;
        state_.errors = {};
        state_.robot_mode = RobotMode::kIdle;
        break;
    }
    answer(header.command, header.id, std::as_bytes(std::span(&status, 1)));
  }

  void connect(const CommandHeader& header, std::span<const std::byte> body) {
    if (!behaviour_.answers) return;
    ConnectRequest request;
    std::memcpy(&request, body.data(), sizeof request);
    const bool fits = behaviour_.accepts_any_version || behaviour_.version == request.version;
    const ConnectAnswer response = {.status = static_cast<std::uint8_t>(fits ? 0 : 1),
                                    .version = behaviour_.version};
    answer(header.command, header.id, std::as_bytes(std::span(&response, 1)));
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(request.udp_port);
    client_.length = sizeof to;
    std::memcpy(&client_.address, &to, sizeof to);
    is_connected_ = true;
  }

  void answer(Command command, std::uint32_t id, std::span<const std::byte> body) const {
    std::vector<std::byte> message(sizeof(CommandHeader) + body.size());
    const CommandHeader header = {command, id, static_cast<std::uint32_t>(message.size())};
    std::memcpy(message.data(), &header, sizeof header);
    std::memcpy(&message[sizeof header], body.data(), body.size());
    send(stream_, message.data(), message.size(), MSG_NOSIGNAL);
  }

  void begin_motion(std::uint32_t id) {
    move_id_ = id;
    state_.robot_mode = RobotMode::kMove;
    state_.controller_mode = static_cast<std::uint8_t>(move_.controller_mode);
    // a state counts generators from 1
    state_.motion_generator_mode = static_cast<std::uint8_t>(move_.motion_generator_mode + 1);
    state_.reflex_reason = {};
    ++motions;
  }

  void end_motion(MoveStatus status, RobotMode mode) {
    const bool was_moving = state_.robot_mode == RobotMode::kMove;
    state_.robot_mode = mode;
    state_.controller_mode = 3;
    state_.motion_generator_mode = 0;
    state_.tau_J_d = state_.dq_d = state_.ddq_d = {};
    const auto byte = static_cast<std::uint8_t>(status);
    if (was_moving) answer(Command::kMove, move_id_, std::as_bytes(std::span(&byte, 1)));
  }

  void take(udp::UdpSocket& socket) {
    udp::Datagram datagram;
    udp::Peer from;
    while (socket.receive(datagram, from)) {
      if (datagram.size != sizeof last_) continue;
      std::memcpy(&last_, datagram.bytes.data(), sizeof last_);
      ++commands;
      if (state_.robot_mode != RobotMode::kMove) continue;
      if (move_.controller_mode == kJointImpedance) {
        follow_speeds();
        continue;
      }
      // members of a packed message are not aligned: copied as a whole
      const std::array<double, kJoints> commanded = last_.tau_J_d;
      std::array<float, kJoints> tau_d = state_.tau_J_d;
      for (int i = 0; i < kJoints; ++i) {
        largest_step_ = std::max(largest_step_, std::abs(commanded[i] - tau_d[i]));
        tau_d[i] = static_cast<float>(commanded[i]);
      }
      state_.tau_J_d = tau_d;
      if (behaviour_.yields && last_.torque_command_finished == 0) yield();
      if (last_.torque_command_finished != 0) end_motion(MoveStatus::kSuccess, RobotMode::kIdle);
    }
  }

  // integrates speeds, and keeps the largest changes from one command to the next
  void follow_speeds() {
    const std::array<double, kJoints> speeds = last_.dq_c;
    std::array<float, kJoints> q = state_.q, speed = state_.dq_d, acceleration = state_.ddq_d;
    for (int i = 0; i < kJoints; ++i) {
      const double next = (speeds[i] - speed[i]) / kPeriod_s;
      largest_acceleration_ = std::max(largest_acceleration_, std::abs(next));
      largest_jerk_ = std::max(largest_jerk_, std::abs(next - acceleration[i]) / kPeriod_s);
      speed[i] = static_cast<float>(speeds[i]);
      acceleration[i] = static_cast<float>(next);
      q[i] += static_cast<float>(kPeriod_s * speeds[i]);
    }
    state_.q = state_.q_d = q;
    state_.dq = state_.dq_d = speed;
    state_.ddq_d = acceleration;
    if (last_.motion_generation_finished != 0) end_motion(MoveStatus::kSuccess, RobotMode::kIdle);
  }

  // moves as one that yields to torques as honey does
  void yield() {
    std::array<float, kJoints> q = state_.q;
    const std::array<float, kJoints> tau_d = state_.tau_J_d;
    for (int i = 0; i < kJoints; ++i) q[i] += 1e-4F * tau_d[i];
    state_.q = q;
  }

  // a period is over when the last state was answered, at the latest after 1 ms
  void send_state(udp::UdpSocket& socket) {
    if (states_to_send_.load() == 0) return socket.wait(now_ns() + 100'000);
    if (states_to_send_.load() > 0) states_to_send_.fetch_sub(1);
    newest = static_cast<int>(state_.message_id = id_++);
    state_.tau_ext_hat_filtered = behaviour_.tau_ext;
    std::array<float, 6> wrench = behaviour_.K_F_ext;
    wrench[2] -= behaviour_.weight_per_kg * (behaviour_.tool_kg - state_.m_load);
    state_.K_F_ext_hat_K = wrench;
    state_.m_ee = behaviour_.m_ee;
    const bool moves = state_.robot_mode == RobotMode::kMove;
    state_.control_command_success_rate = moves ? behaviour_.success_rate : 0.0F;
    const auto datagram = std::as_bytes(std::span(&state_, 1));
    if (behaviour_.sends_nonsense) socket.send(datagram.first(100), client_);
    socket.send(datagram, client_);
    socket.wait(now_ns() + 1'000'000);
  }

  std::mutex mutex_;
  Behaviour behaviour_;
  RobotState state_;
  RobotCommand last_;
  LoadRequest load_;
  CollisionRequest collision_;
  MoveRequest move_;
  double largest_step_ = 0.0, largest_acceleration_ = 0.0, largest_jerk_ = 0.0;
  std::uint64_t id_ = 1;
  std::uint32_t move_id_ = 0;
  udp::Peer client_;
  bool is_connected_ = false, is_leaving_ = false;
  int listener_ = -1, stream_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<int> states_to_send_{-1};  ///< -1: as many as there are
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace hg::franka
