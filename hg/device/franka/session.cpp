#include "hg/device/franka/session.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <memory>

#include "hg/core/error.h"
#include "hg/device/franka/words.h"

namespace hg::franka {
namespace {

constexpr std::int64_t kLook = 5'000'000;  // ns between looks at the stream
constexpr std::size_t kLargestRequest = sizeof(CommandHeader) + sizeof(CollisionRequest);

std::int64_t ns(double seconds) noexcept { return std::llround(1e9 * seconds); }

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses resolve(const udp::Address& address, const std::string& at) {
  addrinfo hints{};
  hints.ai_family = AF_INET;  // the robot knows no other
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
  if (error != 0) throw SetupError(fmt::format("{}: no such host: {}", at, gai_strerror(error)));
  return {found, &freeaddrinfo};
}

// error of a connection that is being made, once it is known; 0: connected
int await_connection(int stream, double timeout_s) noexcept {
  pollfd one{.fd = stream, .events = POLLOUT, .revents = 0};
  const int ready = poll(&one, 1, static_cast<int>(1000.0 * timeout_s));
  if (ready == 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(stream, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

std::string connection_words(int error, double timeout_s) {
  switch (error) {
    case ECONNREFUSED:
      return "the robot refuses the connection: activate FCI in Desk";
    case ETIMEDOUT:
      return fmt::format("no answer within {:g} s: is that the robot's address, and is it on?",
                         timeout_s);
    case EHOSTUNREACH:
    case ENETUNREACH:
      return "no route to the robot: look at cable, network and address of this computer";
    default:
      return std::strerror(error);
  }
}

}  // namespace

Session::Session(const udp::Address& address, const Timeouts& timeouts)
    : at_(address.host + ":" + address.port),
      timeouts_(timeouts),
      socket_(udp::UdpSocket::listening_at({"0.0.0.0", "0"})) {
  try {
    connect(address, timeouts.connect_s);
    greet(timeouts.answer_s);
    await_first_state(timeouts.first_state_s);
  } catch (...) {
    if (stream_ >= 0) close(stream_);
    throw;
  }
}

Session::~Session() {
  shutdown(stream_, SHUT_RDWR);
  close(stream_);
}

void Session::connect(const udp::Address& address, double timeout_s) {
  const Addresses all = resolve(address, at_);
  stream_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  int error = stream_ < 0 ? errno : 0;
  if (error == 0 && ::connect(stream_, all->ai_addr, all->ai_addrlen) != 0) {
    error = errno == EINPROGRESS ? await_connection(stream_, timeout_s) : errno;
  }
  if (error != 0) throw SetupError(at_ + ": " + connection_words(error, timeout_s));
  const int on = 1;
  setsockopt(stream_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  robot_.length = sizeof robot_.address;
  getpeername(stream_, reinterpret_cast<sockaddr*>(&robot_.address), &robot_.length);
}

void Session::greet(double timeout_s) {
  sockaddr_in own{};
  const udp::Peer here = socket_.own_address();
  std::memcpy(&own, &here.address, sizeof own);
  const std::uint32_t id = send(Command::kConnect, ConnectRequest{.udp_port = ntohs(own.sin_port)});
  Answer answer;
  if (!await_answer(id, timeout_s, answer)) {
    throw SetupError(at_ +
                     (is_closed_ ? ": the connection was closed at once"
                                 : fmt::format(": connected, but no answer to Connect within "
                                               "{:g} s",
                                               timeout_s)) +
                     ": does another program control the robot?");
  }
  if (answer.status == 0) return;
  throw SetupError(fmt::format(
      "{}: the robot speaks version {} of FCI, {} is needed (FR3 with system 5.9 or newer)", at_,
      answer.version, kVersion));
}

void Session::await_first_state(double timeout_s) {
  RobotState state;
  const std::int64_t deadline = now_ns() + ns(timeout_s);
  while (now_ns() < deadline) {
    if (receive(state)) return;
    wait(deadline);
  }
  throw SetupError(fmt::format(
      "{}: connected, but no state has come by UDP within {:g} s: does a firewall drop it?", at_,
      timeout_s));
}

std::uint32_t Session::send(Command command, std::span<const std::byte> payload) noexcept {
  std::array<std::byte, kLargestRequest> message;
  const std::size_t size = sizeof(CommandHeader) + payload.size();
  if (is_closed_ || size > message.size()) return 0;
  const CommandHeader header = {command, ++last_id_, static_cast<std::uint32_t>(size)};
  std::memcpy(message.data(), &header, sizeof header);
  if (!payload.empty()) std::memcpy(&message[sizeof header], payload.data(), payload.size());
  const auto sent = ::send(stream_, message.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent == static_cast<ssize_t>(size)) return header.id;
  is_closed_ = true;  // part of a message cannot be taken back
  return 0;
}

void Session::read_stream() noexcept {
  const auto room = std::span(answers_).subspan(waiting_);
  if (is_closed_ || room.empty()) return;
  const auto size = recv(stream_, room.data(), room.size(), MSG_DONTWAIT);
  if (size > 0) {
    waiting_ += static_cast<std::size_t>(size);
  } else if (size == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) {
    is_closed_ = true;
  }
}

bool Session::receive(Answer& answer) noexcept {
  read_stream();
  constexpr std::size_t kLeast = sizeof(CommandHeader) + 1;
  if (waiting_ < kLeast) return false;
  std::memcpy(&answer.header, answers_.data(), sizeof answer.header);
  const std::size_t size = answer.header.size;
  if (size < kLeast || size > answers_.size()) {
    is_closed_ = true;
    waiting_ = 0;
    return false;
  }
  if (waiting_ < size) return false;
  ConnectAnswer body;
  std::memcpy(&body, &answers_[sizeof(CommandHeader)],
              std::min(sizeof body, size - sizeof(CommandHeader)));
  answer.status = body.status;
  answer.version = body.version;
  waiting_ -= size;
  std::memmove(answers_.data(), &answers_[size], waiting_);
  return true;
}

bool Session::await_answer(std::uint32_t id, double timeout_s, Answer& answer) noexcept {
  const std::int64_t deadline = now_ns() + ns(timeout_s);
  RobotState ignored;
  while (id != 0 && now_ns() < deadline) {
    while (receive(answer)) {
      if (answer.header.id == id) return true;
    }
    if (is_closed_) return false;
    while (receive(ignored)) {
    }
    wait(std::min(now_ns() + kLook, deadline));
  }
  return false;
}

void Session::await(Command command, std::uint32_t id, const std::string& what) {
  Answer answer;
  if (!await_answer(id, timeouts_.answer_s, answer)) {
    throw SetupError(
        fmt::format("{}: {}: no answer of the robot within {:g} s", at_, what, timeouts_.answer_s));
  }
  if (answer.status != 0) {
    throw SetupError(
        fmt::format("{}: {}: the robot says: {}", at_, what, answer_words(command, answer.status)));
  }
}

bool Session::is_of_robot(const udp::Peer& from) const noexcept {
  if (has_states_) return from == states_;
  sockaddr_in there{}, robot{};
  std::memcpy(&there, &from.address, sizeof there);
  std::memcpy(&robot, &robot_.address, sizeof robot);
  return from.length == sizeof there && there.sin_addr.s_addr == robot.sin_addr.s_addr;
}

bool Session::receive(RobotState& state) noexcept {
  udp::Peer from;
  while (socket_.receive(datagram_, from)) {
    if (datagram_.size != sizeof state || !is_of_robot(from)) {
      ++foreign_;
      continue;
    }
    std::memcpy(&state, datagram_.bytes.data(), sizeof state);
    states_ = from;
    has_states_ = true;
    return true;
  }
  return false;
}

void Session::send(const RobotCommand& command) noexcept {
  socket_.send(std::as_bytes(std::span(&command, 1)), states_);
}

}  // namespace hg::franka
