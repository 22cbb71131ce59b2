#include "hg/teleoperation/leader_half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/teleoperation/remote_half.h"

namespace hg::teleoperation {
namespace {

constexpr double kDt = 1e-3;

// A leader, and a remote side that answers what the test wants.
struct Bench {
  LeaderHalf half{{.kind = MethodKind::kPositionForce}, {}, kDt};
  PortVector x = PortVector::Zero(1), v = x, f_hand = x, end_stiffness;
  LeaderPacket sent;
  double force = 0.0;
  int period = 0;
  bool is_closed = true, is_linked = true;
  double reflected = -5.0;
  double answered_s = 0.0;
  RemoteCause cause = RemoteCause::kNone;
  std::function<void(RemotePacket&)> spoil = [](RemotePacket&) {};

  RemotePacket answer() const {
    const PortVector zero = PortVector::Zero(1);
    return {.sequence = static_cast<std::uint64_t>(period),
            .engagement = sent.engagement,
            .sent_s = period * kDt,
            .answered_s = answered_s,
            .cause = cause,
            .x = zero,
            .v = zero,
            .x_target = zero,
            .f = zero,
            .reflected = PortVector::Constant(1, reflected),
            .wave = zero,
            .energy = zero};
  }
  void play(double seconds) {
    const int end = period + static_cast<int>(std::lround(seconds / kDt));
    while (period < end) {
      ++period;
      if (is_linked) {
        RemotePacket packet = answer();
        spoil(packet);
        half.receive(packet, period * kDt);
      }
      force = half.step(period * kDt,
                        {.x = x,
                         .v = v,
                         .f_hand = f_hand,
                         .is_clutch_closed = is_closed,
                         .end_stiffness = end_stiffness},
                        sent)[0];
    }
  }
};

TEST(LeaderHalf, TheForceBeginsFromZeroOnceTheRemoteMachineAnswers) {
  Bench bench;
  bench.play(0.003);
  EXPECT_LT(std::abs(bench.force), 0.2);
  bench.play(0.2);
  EXPECT_EQ(bench.force, -5.0);
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged);
}

TEST(LeaderHalf, WithoutAnAnswerThereIsNoForce) {
  Bench bench;
  bench.spoil = [](RemotePacket& packet) { packet.engagement = 0; };
  bench.play(0.5);
  EXPECT_EQ(bench.force, 0.0);
}

TEST(LeaderHalf, TheForceFadesWithin200MsOfALostLinkAndReturnsByTheClutchOnly) {
  Bench bench;
  bench.play(0.5);
  bench.is_linked = false;
  bench.play(0.198);
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged);
  bench.play(0.004);
  EXPECT_EQ(bench.half.link(), RemoteLink::kLost);
  EXPECT_EQ(bench.half.cause(), RemoteCause::kSilent);
  bench.play(0.2);
  EXPECT_EQ(bench.force, 0.0);
  EXPECT_EQ(bench.sent.engagement, 0U);
  bench.is_linked = true;
  bench.play(1.0);
  EXPECT_EQ(bench.half.link(), RemoteLink::kLost) << "nothing begins without an act";
  EXPECT_EQ(bench.force, 0.0);
  bench.is_closed = false;
  bench.play(0.1);
  bench.is_closed = true;
  bench.play(0.3);
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged);
  EXPECT_EQ(bench.sent.engagement, 2U);
  EXPECT_EQ(bench.force, -5.0);
}

TEST(LeaderHalf, ARemoteMachineThatHoldsEndsTheEngagementWithItsCause) {
  Bench bench;
  bench.play(0.5);
  bench.cause = RemoteCause::kJump;
  bench.play(0.3);
  EXPECT_EQ(bench.half.link(), RemoteLink::kLost);
  EXPECT_EQ(bench.half.cause(), RemoteCause::kJump);
  EXPECT_EQ(bench.force, 0.0);
}

TEST(LeaderHalf, ALimitOfTheRemoteMachineIsReportedAndEndsNothing) {
  Bench bench;
  bench.cause = RemoteCause::kRange;
  bench.play(0.5);
  EXPECT_EQ(bench.half.cause(), RemoteCause::kRange);
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged);
}

TEST(LeaderHalf, ALyingRemoteMachineIsNotFelt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::function<void(RemotePacket&)> lies[] = {
      [&](RemotePacket& packet) { packet.reflected[0] = nan; },
      [&](RemotePacket& packet) { packet.x[0] = std::numeric_limits<double>::infinity(); },
      [&](RemotePacket& packet) { packet.energy[0] = nan; },
      [&](RemotePacket& packet) { packet.model.stiffness = nan; },
      [&](RemotePacket& packet) { packet.reflected = PortVector::Zero(3); },
      [&](RemotePacket& packet) { packet.x = PortVector(); }};
  for (const auto& lie : lies) {
    Bench bench;
    bench.play(0.5);
    bench.spoil = lie;
    bench.play(0.001);
    EXPECT_EQ(bench.half.link(), RemoteLink::kLost);
    EXPECT_EQ(bench.half.cause(), RemoteCause::kNotFinite);
    EXPECT_TRUE(std::isfinite(bench.force));
    bench.play(0.2);
    EXPECT_EQ(bench.force, 0.0);
  }
}

// Whatever it says of itself: it has confirmed the engagement and no longer follows.
TEST(LeaderHalf, ARemoteMachineThatLeavesTheEngagementIsLost) {
  for (const std::uint32_t engagement : {0U, 9U}) {
    Bench bench;
    bench.play(0.5);
    bench.spoil = [&](RemotePacket& packet) { packet.engagement = engagement; };
    bench.play(0.001);
    EXPECT_EQ(bench.half.link(), RemoteLink::kLost);
    bench.play(0.2);
    EXPECT_EQ(bench.force, 0.0);
    bench.spoil = [](RemotePacket&) {};
    bench.play(0.5);
    EXPECT_EQ(bench.force, 0.0) << "by the clutch only";
  }
}

// The hand gets 59 N along its motion, and 5 J within a third of a second.
TEST(LeaderHalf, ARemoteMachineThatDrivesTheHandIsLost) {
  Bench bench;
  bench.play(0.5);
  double given = 0.0;
  for (int k = 0; k < 1000 && bench.half.link() == RemoteLink::kEngaged; ++k) {
    bench.v[0] = 3e-3 * k;
    bench.x[0] += bench.v[0] * kDt;
    bench.reflected = 59.0;
    bench.play(kDt);
    given += bench.force * bench.v[0] * kDt;
  }
  EXPECT_EQ(bench.half.link(), RemoteLink::kLost);
  EXPECT_EQ(bench.half.cause(), RemoteCause::kActive);
  EXPECT_LT(given, 20.0);
  EXPECT_GT(given, 5.0);
}

TEST(LeaderHalf, ASpringGivesBackWhatItHasTaken) {
  Bench bench;
  for (int k = 0; k < 20000; ++k) {
    bench.x[0] = 0.2 * std::sin(2.0 * k * kDt);
    bench.v[0] = 0.4 * std::cos(2.0 * k * kDt);
    bench.reflected = -200.0 * bench.x[0];
    bench.spoil = [&](RemotePacket& packet) { packet.x = packet.x_target = bench.x; };
    bench.play(kDt);
  }
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged);
}

TEST(LeaderHalf, ARemoteMachineWhoseValuesAreFrozenIsLostOnceTheLeaderMoves) {
  Bench bench;
  bench.play(2.0);
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged) << "at rest";
  for (int k = 0; k < 300; ++k) {
    bench.x[0] = 1e-4 * k;
    bench.play(kDt);
  }
  bench.play(0.3);
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged) << "it has not answered yet";
  bench.answered_s = bench.period * kDt;
  bench.play(0.002);
  EXPECT_EQ(bench.half.link(), RemoteLink::kLost);
  EXPECT_EQ(bench.half.cause(), RemoteCause::kFrozen);
}

TEST(LeaderHalf, AFirstPacketWithoutNumbersIsForgotten) {
  Bench bench;
  bench.spoil = [](RemotePacket& packet) {
    packet.x[0] = std::numeric_limits<double>::quiet_NaN();
  };
  bench.play(0.1);
  EXPECT_EQ(bench.half.link(), RemoteLink::kWaiting);
  bench.spoil = [](RemotePacket&) {};
  bench.play(0.3);
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged);
  EXPECT_EQ(bench.force, -5.0);
}

TEST(LeaderHalf, RepeatedPacketsAreSilence) {
  Bench bench;
  bench.play(0.5);
  bench.spoil = [](RemotePacket& packet) { packet.sequence = 100 + packet.sequence % 100; };
  bench.play(0.25);
  EXPECT_EQ(bench.half.link(), RemoteLink::kLost);
}

TEST(LeaderHalf, TheForceIsCutAtItsLimit) {
  Bench bench;
  bench.reflected = -1e4;
  bench.play(0.5);
  EXPECT_EQ(bench.force, -60.0);
}

TEST(LeaderHalf, EngagesOnlyWhereBothSidesAreTogetherIfAsked) {
  LeaderHalf half(MethodConfig{}, {.snapshot = 0.02}, kDt);
  Bench bench;
  bench.half = std::move(half);
  bench.x[0] = 0.05;
  bench.play(0.3);
  EXPECT_EQ(bench.half.link(), RemoteLink::kReleased);
  bench.x[0] = 0.01;
  bench.play(0.3);
  EXPECT_EQ(bench.half.link(), RemoteLink::kEngaged);
}

TEST(LeaderHalf, DoesNotAllocate) {
  for (const MethodKind kind :
       {MethodKind::kPositionForce, MethodKind::kFourChannel, MethodKind::kWaveVariables,
        MethodKind::kPassivityControl, MethodKind::kModelMediated}) {
    LeaderHalf leader({.kind = kind}, {}, kDt);
    const LimiterConfig limits = {.axes = {{.range = {-1.0, 1.0}}}};
    RemoteHalf remote({.kind = kind}, {}, limits, kDt);
    SimulatedMachine machine({.x_start = PortVector::Zero(1)}, kDt);
    MachineState state;
    LeaderPacket to_remote;
    RemotePacket to_leader;
    PortVector x = PortVector::Zero(1), v = PortVector::Constant(1, 0.1), f = x;
    const AllocationCounter allocations;
    for (int k = 0; k < 500; ++k) {
      x[0] = 1e-4 * k;
      leader.step(k * kDt, {.x = x, .v = v, .f_hand = f, .is_clutch_closed = true}, to_remote);
      remote.receive(to_remote, k * kDt);
      machine.read(state);
      machine.write(remote.step(k * kDt, state, to_leader));
      leader.receive(to_leader, k * kDt);
    }
    EXPECT_EQ(allocations.count(), 0U);
    EXPECT_GT(state.x[0], 0.01);
  }
}

TEST(LeaderHalf, RefusesConfigurationsThatMakeNoSense) {
  EXPECT_THROW(LeaderHalf(MethodConfig{}, {.silence = 0.0}, kDt), SetupError);
  EXPECT_THROW(LeaderHalf({.impedance = -1.0}, {}, kDt), SetupError);
}

// The leader moves slowly beyond an end of the machine's range.
double force_beyond(double depth, double motion_scale) {
  LeaderConfig config;
  config.ranges = {{-0.1, 0.3}};
  Bench bench;
  bench.reflected = 0.0;
  bench.half = LeaderHalf({.kind = MethodKind::kPositionForce}, config, kDt);
  bench.end_stiffness = PortVector::Constant(1, 5e3 / motion_scale);
  bench.play(0.5);
  bench.x[0] = 0.3 + motion_scale * depth;
  bench.play(0.5);
  return bench.force;
}

TEST(LeaderHalf, TheEndOfTheMachinesRangeIsFeltWithinTwoMillimetresAtEveryScale) {
  for (const double scale : {0.1, 1.0, 5.0}) {
    EXPECT_EQ(force_beyond(-1e-3, scale), 0.0) << "before the end";
    EXPECT_NEAR(force_beyond(2e-3, scale), -10.0, 1e-6) << scale;
  }
}

TEST(LeaderHalf, TheEndOfTheMachinesRangeFadesWithTheLink) {
  LeaderConfig config;
  config.ranges = {{-0.1, 0.3}};
  Bench bench;
  bench.reflected = 0.0;
  bench.half = LeaderHalf({.kind = MethodKind::kPositionForce}, config, kDt);
  bench.end_stiffness = PortVector::Constant(1, 5e3);
  bench.play(0.5);
  bench.x[0] = 0.304;
  bench.play(0.3);
  EXPECT_NEAR(bench.force, -20.0, 1e-6);
  bench.is_linked = false;
  bench.play(0.401);
  EXPECT_EQ(bench.force, 0.0);
}

}  // namespace
}  // namespace hg::teleoperation
