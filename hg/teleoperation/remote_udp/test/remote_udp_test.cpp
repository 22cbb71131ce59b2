/// A leader and a remote machine over 127.0.0.1, honest and not. No test passes or fails by the
/// clock: in lock-step time is the leader's, else a test waits until something has happened.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hg/core/error.h"
#include "hg/teleoperation/leader_half.h"
#include "hg/teleoperation/remote_udp/remote_server.h"
#include "hg/teleoperation/remote_udp/udp_remote.h"

namespace hg::teleoperation {
namespace {

constexpr double kDt = 1e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array kMethods = {MethodKind::kPositionForce, MethodKind::kFourChannel,
                                 MethodKind::kWaveVariables, MethodKind::kPassivityControl,
                                 MethodKind::kModelMediated};

PortVector one(double value) { return PortVector::Constant(1, value); }

const LimiterConfig kLimits = {.axes = {{.range = {-0.5, 0.5}}}};

SimulatedMachineConfig machine_at_wall() {
  return {.walls = {{.normal = one(-1.0), .offset = -0.03}}, .x_start = one(0.0)};
}

udp::Key key_of(char letter) {
  const std::vector<std::byte> secret(32, std::byte(letter));
  return udp::Key(secret);
}

RemoteDescription description(bool is_lock_step) {
  return {.size = 1, .rate_Hz = 1.0 / kDt, .is_lock_step = is_lock_step};
}

RemoteServerConfig server_config(bool is_lock_step, const udp::Key& key = {}) {
  return {.description = description(is_lock_step),
          .impedance = machine_at_wall().impedance,
          .limiter = kLimits,
          .server = "test",
          .key = key};
}

udp::Address address_of(const RemoteServer& server) {
  return udp::parse_address("test", server.address());
}

// A simulated machine and its server, in a thread.
class Serving {
 public:
  explicit Serving(bool is_lock_step, const udp::Address& address = {"127.0.0.1", "0"})
      : server_(address, server_config(is_lock_step)),
        is_lock_step_(is_lock_step),
        thread_([this] { live(); }) {}
  ~Serving() {
    stop_.store(true);
    thread_.join();
  }
  udp::Address address() const { return address_of(server_); }

 private:
  void live() {
    SimulatedMachine machine(machine_at_wall(), kDt);
    MachineState state;
    RemoteTarget target;
    while (!stop_.load()) {
      machine.read(state);
      if (server_.step(state, target)) machine.write(target);
      if (!is_lock_step_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  RemoteServer server_;
  bool is_lock_step_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

UdpRemoteConfig leader_config(bool is_lock_step, MethodKind kind = MethodKind::kPositionForce) {
  return {.description = description(is_lock_step),
          .method = {.kind = kind},
          .client = "leader",
          .answer_timeout_s = 60.0,
          .lock_step_timeout_s = 60.0};
}

// Positions of machine and target, and the force on the leader, of a motion into the wall and back.
std::vector<double> played(RemoteSide& remote, MethodKind kind) {
  LeaderHalf leader({.kind = kind}, {}, kDt);
  LeaderPacket sent;
  RemotePacket arrived;
  std::vector<double> result;
  for (int period = 0; period < 1500; ++period) {
    const double now_s = period * kDt;
    const PortVector x = one(0.04 * std::sin(4.0 * now_s)), v = one(0.16 * std::cos(4.0 * now_s));
    const PortVector f = one(3.0);
    result.push_back(leader.step(
        now_s, {.x = x, .v = v, .f_hand = f, .is_clutch_closed = period > 50 && period < 1200},
        sent)[0]);
    remote.send(sent, now_s);
    remote.step(now_s);
    while (remote.receive(arrived)) {
      leader.receive(arrived, now_s);
      result.insert(result.end(), {arrived.x[0], arrived.x_target[0], arrived.f[0]});
    }
  }
  return result;
}

TEST(UdpRemote, InLockStepAMachineBehavesAsIfItWereHere) {
  for (const MethodKind kind : kMethods) {
    SimulatedRemote here({.kind = kind}, kLimits, machine_at_wall(), kDt);
    const std::vector<double> expected = played(here, kind);
    Serving serving(true);
    UdpRemote there(serving.address(), leader_config(true, kind));
    EXPECT_EQ(played(there, kind), expected) << static_cast<int>(kind);
  }
}

// A leader with the right key that says what a test wants, and a machine that stands where its
// target is. In lock-step.
class Liar {
 public:
  explicit Liar(const udp::Key& key = {}) : server({"127.0.0.1", "0"}, server_config(true, key)) {
    std::thread thread([&] {
      guest = std::make_unique<udp::SessionGuest>(
          address_of(server), udp::GuestConfig{.expected = to_message(description(true)),
                                               .client = "liar",
                                               .answer_timeout_s = 60.0,
                                               .key = key});
      guest->send(to_message({.kind = kind}));
    });
    while (!server.has_leader()) server.step({one(0.0), one(0.0), one(0.0)}, target);
    thread.join();
    target = {one(0.0), one(0.0), one(0.0)};
  }
  LeaderPacket packet(double x, std::uint32_t engagement = 1) {
    return {.sequence = ++sequence,
            .engagement = engagement,
            .sent_s = now_s + kDt,
            .x = one(x),
            .v = one(0.0),
            .f = one(0.0),
            .wave = one(0.0),
            .energy = one(0.0)};
  }
  void say(const LeaderPacket& packet) {
    now_s += kDt;
    guest->send(udp::LeaderMessage{.period = ++period, .time_s = now_s, .packet = packet});
    while (!server.step({target.x, one(0.0), one(0.0)}, target)) {
    }
  }
  // Engages, and leads the machine for a moment.
  void engage() {
    say(packet(0.0, 0));
    for (int i = 0; i < 100; ++i) say(packet(0.01 * i / 100.0));
    ASSERT_EQ(server.cause(), RemoteCause::kNone);
    ASSERT_GT(target.x[0], 0.005);
  }
  // What the machine does in the next second, while the leader goes to 0.1.
  void expect_held(RemoteCause cause) {
    EXPECT_EQ(server.cause(), cause);
    const double before = target.x[0];
    for (int i = 0; i < 1000; ++i) {
      say(packet(0.1));
      ASSERT_TRUE(std::isfinite(target.x[0]));
      ASSERT_EQ(server.cause(), cause);
    }
    EXPECT_NEAR(target.x[0], before, 2e-3);
    say(packet(0.1, 0));
    for (int i = 0; i < 300; ++i) say(packet(target.x[0], 2));
    EXPECT_EQ(server.cause(), RemoteCause::kNone) << "the clutch was used";
  }

  MethodKind kind = MethodKind::kPositionForce;
  RemoteServer server;
  std::unique_ptr<udp::SessionGuest> guest;
  RemoteTarget target;
  std::uint64_t period = 0, sequence = 0;
  double now_s = 0.0;
};

TEST(RemoteServer, ANumberThatIsNoneMakesTheMachineHoldUntilTheClutchIsUsed) {
  for (const double bad : {kNan, 1e300, -std::numeric_limits<double>::infinity()}) {
    for (const int where : {0, 1, 2}) {
      Liar liar;
      liar.engage();
      LeaderPacket packet = liar.packet(0.01);
      (where == 0 ? packet.x : where == 1 ? packet.f : packet.wave)[0] = bad;
      liar.say(packet);
      liar.expect_held(RemoteCause::kNotFinite);
    }
  }
}

TEST(RemoteServer, AVectorThatIsTooShortMakesTheMachineHold) {
  Liar liar;
  liar.engage();
  LeaderPacket packet = liar.packet(0.01);
  packet.f.resize(0);
  liar.say(packet);
  liar.expect_held(RemoteCause::kNotFinite);
}

TEST(RemoteServer, AJumpMakesTheMachineHold) {
  Liar liar;
  liar.engage();
  liar.say(liar.packet(0.3));
  liar.expect_held(RemoteCause::kJump);
}

TEST(RemoteServer, PacketsThatAreRepeatedOrFrozenMakeTheMachineHold) {
  for (const bool is_frozen : {false, true}) {
    Liar liar;
    liar.engage();
    LeaderPacket packet = liar.packet(0.011);
    for (int i = 0; i < 300; ++i) {
      if (is_frozen) packet.sequence = ++liar.sequence;
      liar.say(packet);
    }
    liar.expect_held(is_frozen ? RemoteCause::kFrozen : RemoteCause::kReplayed);
  }
}

TEST(RemoteServer, ALeaderWithoutPacketsMakesTheMachineHold) {
  Liar liar;
  liar.engage();
  for (int i = 0; i < 300; ++i) liar.say({});
  liar.expect_held(RemoteCause::kSilent);
}

TEST(RemoteServer, ALeaderThatComesWithAClosedClutchIsNotFollowed) {
  Liar liar;
  for (int i = 0; i < 500; ++i) liar.say(liar.packet(0.01));
  EXPECT_EQ(liar.server.cause(), RemoteCause::kReleased);
  EXPECT_EQ(liar.target.x[0], 0.0);
}

TEST(RemoteServer, ADatagramCountsOnce) {
  Liar liar;
  liar.engage();
  const double before = liar.target.x[0];
  const udp::LeaderMessage again = {
      .period = liar.period, .time_s = liar.now_s, .packet = liar.packet(0.2)};
  for (int i = 0; i < 50; ++i) liar.guest->send(again);
  EXPECT_FALSE(liar.server.step({liar.target.x, one(0.0), one(0.0)}, liar.target));
  EXPECT_EQ(liar.target.x[0], before);
}

std::string refusal(RemoteServer& server, const udp::GuestConfig& config) {
  std::atomic<bool> is_over{false};
  std::string message;
  std::thread thread([&] {
    try {
      const udp::SessionGuest guest(address_of(server), config);
    } catch (const SetupError& error) {
      message = error.what();
    }
    is_over.store(true);
  });
  RemoteTarget target;
  while (!is_over.load()) server.step({one(0.0), one(0.0), one(0.0)}, target);
  thread.join();
  return message;
}

TEST(RemoteServer, RefusesASecondOperatorAnotherKeyAndAnotherMachine) {
  Liar liar(key_of('a'));
  liar.engage();
  udp::GuestConfig other = {.expected = to_message(description(true)),
                            .what = "remote machine",
                            .client = "other",
                            .answer_timeout_s = 60.0,
                            .key = key_of('a')};
  EXPECT_NE(refusal(liar.server, other).find("refuses: liar at 127.0.0.1"), std::string::npos);
  other.key = key_of('b');
  EXPECT_NE(refusal(liar.server, other).find("its key is another one"), std::string::npos);
  other.key = {};
  EXPECT_NE(refusal(liar.server, other).find("its key is another one"), std::string::npos);
  EXPECT_EQ(liar.server.counts().refused, 3U);
  liar.say(liar.packet(0.01));
  EXPECT_EQ(liar.server.cause(), RemoteCause::kNone) << "the first one still leads";
  RemoteServer free({"127.0.0.1", "0"}, server_config(true));
  other.expected = to_message(RemoteDescription{.size = 2, .is_lock_step = true});
  EXPECT_NE(refusal(free, other).find("joints: 1, expected 2"), std::string::npos);
}

TEST(RemoteServer, WhatOthersSendIntoASessionDoesNothing) {
  Liar liar(key_of('a'));
  liar.engage();
  const double before = liar.target.x[0];
  udp::UdpSocket stranger = udp::UdpSocket::talking_to(address_of(liar.server));
  udp::Datagram datagram;
  for (int i = 0; i < 40; ++i) {
    udp::encode({.session = 1, .number = 1000}, udp::LeaderMessage{.packet = liar.packet(0.2)},
                datagram, key_of(i % 2 == 0 ? 'a' : 'b'));
    stranger.send(datagram.view());
  }
  liar.say(liar.packet(0.01));
  EXPECT_EQ(liar.server.cause(), RemoteCause::kNone);
  EXPECT_NEAR(liar.target.x[0], before, 1e-3);
  EXPECT_EQ(liar.server.counts().from_others, 40U);
}

TEST(RemoteServer, AnImpossibleMethodEndsTheSession) {
  RemoteServer server({"127.0.0.1", "0"}, server_config(true));
  RemoteTarget target;
  std::atomic<bool> is_over{false};
  std::string reason;
  std::thread thread([&] {
    udp::SessionGuest guest(address_of(server),
                            udp::GuestConfig{.expected = to_message(description(true))});
    udp::Terms terms = to_message(MethodConfig{});
    terms.leader_mass = kNan;
    guest.send(terms);
    udp::Header header;
    udp::Goodbye goodbye;
    while (reason.empty()) {
      if (guest.hear(header) != udp::Heard::kMessage) continue;
      if (guest.take(goodbye)) reason = goodbye.reason.printable();
    }
    is_over.store(true);
  });
  while (!is_over.load()) server.step({one(0.0), one(0.0), one(0.0)}, target);
  thread.join();
  EXPECT_EQ(reason, "the method or its parameters are impossible");
  EXPECT_FALSE(server.has_leader());
}

// Answers of a machine, as they come.
struct Answers {
  AnswerGate gate{1};
  RemotePacket passed;
  std::uint64_t sequence = 0;
  double now_s = 0.0;

  RemotePacket next(double x = 0.0) {
    now_s += kDt;
    RemotePacket packet = {
        .sequence = ++sequence, .engagement = 1, .sent_s = now_s, .cause = RemoteCause::kNone};
    for (PortVector* v : {&packet.x, &packet.v, &packet.x_target, &packet.f, &packet.reflected,
                          &packet.wave, &packet.energy}) {
      *v = one(0.0);
    }
    packet.x = one(x);
    return packet;
  }
};

TEST(AnswerGate, ReplacesALieByTheLastGoodAnswerAndNamesIt) {
  const auto expect_named = [](RemoteCause cause, const std::function<void(RemotePacket&)>& spoil) {
    Answers answers;
    ASSERT_TRUE(answers.gate.take(answers.next(0.001), answers.now_s, answers.passed));
    ASSERT_EQ(answers.passed.cause, RemoteCause::kNone);
    RemotePacket packet = answers.next(0.002);
    spoil(packet);
    ASSERT_TRUE(answers.gate.take(packet, answers.now_s, answers.passed));
    EXPECT_EQ(answers.passed.cause, cause);
    EXPECT_EQ(answers.passed.x[0], 0.001);
  };
  const RemoteCause bad = RemoteCause::kNotFinite;
  expect_named(bad, [](RemotePacket& packet) { packet.reflected[0] = kNan; });
  expect_named(bad, [](RemotePacket& packet) { packet.sent_s = kNan; });
  expect_named(bad, [](RemotePacket& packet) { packet.wave[0] = 1e300; });
  expect_named(bad, [](RemotePacket& packet) { packet.energy.resize(0); });
  expect_named(bad, [](RemotePacket& packet) { packet.cause = static_cast<RemoteCause>(200); });
  expect_named(bad, [](RemotePacket& packet) {
    packet.model = {.number = 1, .normal = one(1.0), .stiffness = 1e12};
  });
  expect_named(bad, [](RemotePacket& packet) {
    packet.model = {.number = 1, .normal = one(0.1), .stiffness = 1e3};
  });
  expect_named(RemoteCause::kJump, [](RemotePacket& packet) { packet.x[0] = 0.3; });
}

TEST(AnswerGate, NamesAnswersThatAreRepeatedOrFrozenOnce) {
  for (const bool is_frozen : {false, true}) {
    Answers answers;
    RemotePacket packet = answers.next();
    ASSERT_TRUE(answers.gate.take(packet, answers.now_s, answers.passed));
    int named = 0;
    for (int i = 0; i < 1000; ++i) {
      answers.now_s += kDt;
      if (is_frozen) packet.sequence = ++answers.sequence;
      EXPECT_FALSE(answers.gate.take(packet, answers.now_s, answers.passed));
      if (!answers.gate.check(answers.now_s, answers.passed)) continue;
      ++named;
      EXPECT_EQ(answers.passed.cause, is_frozen ? RemoteCause::kFrozen : RemoteCause::kReplayed);
    }
    EXPECT_GE(named, 1);
  }
}

// A server that has gone and come again knows nothing of the engagement.
void expect_led_only_after_the_clutch_was_used(bool is_restarted_at_once) {
  auto serving = std::make_unique<Serving>(false);
  const udp::Address address = serving->address();
  UdpRemote remote(address, leader_config(false));
  LeaderHalf leader({.kind = MethodKind::kPositionForce}, {}, kDt);
  LeaderPacket sent;
  RemotePacket arrived;
  PortVector x = one(0.0);
  bool is_closed = true;
  double force = 0.0, machine = 0.0;
  const std::int64_t began = now_ns();
  const auto play_until = [&](const std::function<bool()>& is_done) {
    while (!is_done()) {
      ASSERT_LT(now_ns() - began, 60'000'000'000);
      const double now_s = 1e-9 * static_cast<double>(now_ns() - began);
      force = leader.step(
          now_s, {.x = x, .v = one(0.0), .f_hand = one(0.0), .is_clutch_closed = is_closed},
          sent)[0];
      remote.send(sent, now_s);
      remote.step(now_s);
      while (remote.receive(arrived)) {
        leader.receive(arrived, now_s);
        machine = arrived.x[0];
      }
      x[0] = std::min(x[0] + 1e-5, 0.05);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  play_until([&] { return force < -5.0; });
  serving.reset();
  if (is_restarted_at_once) serving = std::make_unique<Serving>(false, address);
  play_until([&] { return leader.link() == RemoteLink::kLost && force == 0.0; });
  if (!is_restarted_at_once) serving = std::make_unique<Serving>(false, address);
  const std::uint64_t before = arrived.sequence;
  play_until([&] { return arrived.sequence > before + 200; });
  EXPECT_EQ(leader.link(), RemoteLink::kLost);
  EXPECT_NEAR(machine, 0.0, 1e-6) << "it has not moved";
  is_closed = false;
  play_until([&] { return sent.engagement == 0 && arrived.sequence > before + 400; });
  is_closed = true;
  play_until([&] { return leader.link() == RemoteLink::kEngaged; });
}

TEST(UdpRemote, AMachineThatComesAgainIsLedOnlyAfterTheClutchWasUsed) {
  expect_led_only_after_the_clutch_was_used(false);
}

// Sooner than a silence would be noticed.
TEST(UdpRemote, AMachineThatIsRestartedAtOnceIsLedOnlyAfterTheClutchWasUsed) {
  expect_led_only_after_the_clutch_was_used(true);
}

}  // namespace
}  // namespace hg::teleoperation
