#include "hg/teleoperation/remote_udp/remote_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hg/core/first_not_finite.h"
#include "hg/teleoperation/remote_udp/plausible.h"

namespace hg::teleoperation {
namespace {

constexpr int kMostAtOnce = 256;             // datagrams per period
constexpr std::int64_t kLook = 100'000'000;  // ns, of a wait in lock-step
constexpr std::size_t kMostNews = 10'000;    // bytes that wait

udp::HostConfig host_of(const RemoteServerConfig& config) {
  return {.actual = to_message(config.description),
          .what = "remote machine",
          .server = config.server,
          .is_simulated = config.is_simulated,
          .silence_s = config.limiter.silence,
          .ready_timeout_s = 5.0,
          .begin = udp::MessageType::kTerms,
          .capture = config.capture,
          .key = config.key};
}

const char* words(RemoteCause cause) noexcept {
  switch (cause) {
    case RemoteCause::kNotFinite:
      return "holds: what arrived was no number, or impossible";
    case RemoteCause::kJump:
      return "holds: the target jumped";
    case RemoteCause::kReplayed:
      return "holds: packets were repeated";
    case RemoteCause::kFrozen:
      return "holds: packets kept coming with the same content";
    case RemoteCause::kSilent:
      return "holds: the leader is silent";
    case RemoteCause::kReleased:
      return "holds: the clutch is open";
    case RemoteCause::kStopped:
      return "holds: protective stop";
    default:
      return "follows";
  }
}

}  // namespace

RemoteServer::RemoteServer(const udp::Address& address, const RemoteServerConfig& config)
    : config_(config),
      host_(address, host_of(config)),
      half_(MethodConfig{.kind = MethodKind::kPositionForce}, config.impedance, config.limiter,
            1.0 / config.description.rate_Hz),
      began_ns_(now_ns()) {}

RemoteServer::~RemoteServer() {
  if (host_.has_client()) host_.leave({udp::Farewell::kDone, "the server was stopped"});
}

void RemoteServer::note(const std::string& line) {
  if (news_.size() < kMostNews) news_ += line + "\n";
}

std::string RemoteServer::news() {
  std::string news;
  news.swap(news_);
  return news;
}

RemoteServer::Event RemoteServer::hear() {
  const bool had_client = host_.has_client();
  udp::Header header;
  switch (host_.hear(header)) {
    case udp::Heard::kNothing:
      return Event::kNothing;
    case udp::Heard::kIgnored:
      return Event::kIgnored;
    case udp::Heard::kMessage:
      break;
  }
  if (!had_client) {
    begin_session();
    return Event::kIgnored;
  }
  return take(static_cast<udp::MessageType>(header.type));
}

void RemoteServer::begin_session() {
  udp::Terms terms;
  const bool is_good = host_.take(terms);
  const std::optional<MethodConfig> method = is_good ? method_of(terms) : std::nullopt;
  if (!method) {
    note(host_.client() + " wants an impossible method");
    host_.leave({udp::Farewell::kFault, "the method or its parameters are impossible"});
    return;
  }
  half_.begin(make_remote_method(*method, config_.impedance, 1.0 / config_.description.rate_Hz));
  is_released_ = false;
  period_ = 0;
  answer_.period = 0;
  heard_ns_ = now_ns();
  note(host_.client() + " leads");
}

void RemoteServer::end_session(const udp::Goodbye& goodbye) {
  note(fmt::format("{}: {}", host_.client(), goodbye.reason.printable()));
  host_.leave(goodbye);
}

RemoteServer::Event RemoteServer::take(udp::MessageType type) {
  switch (type) {
    case udp::MessageType::kLeader:
      if (!host_.take(arrived_)) arrived_.packet.x.resize(0);
      return Event::kPeriod;
    case udp::MessageType::kGoodbye: {
      udp::Goodbye goodbye;
      if (!host_.take(goodbye)) goodbye = {};
      note(fmt::format("{} has left: {}", host_.client(), goodbye.reason.printable()));
      host_.end_session();
      return Event::kIgnored;
    }
    case udp::MessageType::kTerms:  // said again until the first answer has arrived
      return Event::kIgnored;
    default:
      host_.count_foreign();
      return Event::kIgnored;
  }
}

// Hands a packet to the half. What is impossible counts as what is no number.
void RemoteServer::take_period() {
  heard_ns_ = now_ns();
  period_ = std::max(period_, arrived_.period);
  LeaderPacket& packet = arrived_.packet;
  if (packet.sequence == 0) return;
  if (!is_plausible(packet, config_.description.size)) packet.x.resize(0);
  is_released_ = is_released_ || packet.engagement == 0;
  if (!is_released_) return;
  const double now_s = config_.description.is_lock_step
                           ? arrived_.time_s
                           : 1e-9 * static_cast<double>(now_ns() - began_ns_);
  half_.receive(packet, now_s);
}

// In lock-step, until the next period of the leader has come.
bool RemoteServer::await_period() {
  const std::int64_t until = now_ns() + kLook;
  while (now_ns() < until) {
    const Event event = hear();
    if (event == Event::kNothing) host_.wait(until);
    if (event != Event::kPeriod) continue;
    if (arrived_.period == period_ + 1 && std::isfinite(arrived_.time_s)) return true;
    if (arrived_.period == period_) host_.send(answer_);  // it has missed the answer
  }
  return false;
}

bool RemoteServer::step(const MachineState& state, RemoteTarget& target) {
  const bool is_lock_step = config_.description.is_lock_step;
  if (is_lock_step) {
    if (await_period()) {
      take_period();
      time_s_ = arrived_.time_s;
    } else {
      target = target_;
    }
  } else {
    for (int i = 0; i < kMostAtOnce; ++i) {
      const Event event = hear();
      if (event == Event::kNothing) break;
      if (event == Event::kPeriod) take_period();
    }
    time_s_ = 1e-9 * static_cast<double>(now_ns() - began_ns_);
  }
  const bool is_new = answer_.period != period_;
  const double silence_s = 1e-9 * static_cast<double>(now_ns() - heard_ns_);
  if (host_.has_client() && silence_s > config_.session_silence_s) {
    end_session({udp::Farewell::kSilent, "no packet came in time: the machine holds"});
  }
  if (is_lock_step && !is_new) return false;
  answer_.period = period_;
  RemoteTarget wanted = half_.step(time_s_, state, answer_.packet);
  if (first_not_finite(wanted.x, wanted.v, wanted.f) < 0) target_ = wanted;
  target = target_;
  if (host_.has_client()) host_.send(answer_);
  note_changes();
  return true;
}

void RemoteServer::note_changes() {
  const RemoteCause now = answer_.packet.cause;
  const auto kind = [](RemoteCause cause) {
    return holds(cause) || cause == RemoteCause::kReleased ? cause : RemoteCause::kNone;
  };
  if (kind(now) == noted_) return;
  noted_ = kind(now);
  note(words(now));
}

}  // namespace hg::teleoperation
