#include "hg/teleoperation/limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hg/teleoperation/remote_half.h"

namespace hg::teleoperation {
namespace {

constexpr double kDt = 1e-3;

LimiterConfig limits() {
  return {.axes = {{.range = {-0.5, 0.5}, .v_max = 0.4, .a_max = 5.0, .f_max = 20.0}}};
}

LeaderPacket packet(std::uint64_t sequence, double sent_s, double x, std::uint32_t engagement = 1) {
  const PortVector zero = PortVector::Zero(1);
  return {.sequence = sequence,
          .engagement = engagement,
          .sent_s = sent_s,
          .x = PortVector::Constant(1, x),
          .v = zero,
          .f = zero,
          .wave = zero,
          .energy = zero};
}

TEST(PacketGate, FollowsPacketsThatAreNewAndFinite) {
  PacketGate gate(limits());
  EXPECT_EQ(gate.check(0.0), RemoteCause::kReleased);
  for (int k = 1; k < 1000; ++k) {
    EXPECT_TRUE(gate.take(packet(k, k * kDt, 1e-3 * k), k * kDt));
    EXPECT_EQ(gate.check(k * kDt), RemoteCause::kNone);
  }
}

TEST(PacketGate, HoldsForValuesThatAreNotFiniteUntilTheNextEngagement) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int field = 0; field < 5; ++field) {
    PacketGate gate(limits());
    ASSERT_TRUE(gate.take(packet(1, 0.001, 0.0), 0.001));
    LeaderPacket bad = packet(2, 0.002, 0.0);
    (field == 0   ? bad.x
     : field == 1 ? bad.v
     : field == 2 ? bad.f
     : field == 3 ? bad.wave
                  : bad.energy)[0] = nan;
    EXPECT_FALSE(gate.take(bad, 0.002));
    EXPECT_EQ(gate.check(0.002), RemoteCause::kNotFinite);
    EXPECT_FALSE(gate.take(packet(3, 0.003, 0.0), 0.003)) << "the same engagement";
    EXPECT_EQ(gate.check(0.003), RemoteCause::kNotFinite);
    EXPECT_TRUE(gate.take(packet(4, 0.004, 0.0, 2), 0.004));
    EXPECT_EQ(gate.check(0.004), RemoteCause::kNone);
  }
}

TEST(PacketGate, HoldsForAJump) {
  PacketGate gate(limits());
  gate.take(packet(1, 0.001, 0.0), 0.001);
  EXPECT_TRUE(gate.take(packet(2, 0.002, 0.005), 0.002));
  EXPECT_FALSE(gate.take(packet(3, 0.003, 0.1), 0.003));
  EXPECT_EQ(gate.check(0.003), RemoteCause::kJump);
}

TEST(PacketGate, ALongPauseIsNoJump) {
  PacketGate gate(limits());
  gate.take(packet(1, 0.001, 0.0), 0.001);
  EXPECT_TRUE(gate.take(packet(100, 0.1, 0.2), 0.1));
  EXPECT_EQ(gate.check(0.1), RemoteCause::kNone);
}

TEST(PacketGate, NamesWhySilenceIsNoPauseOfTheLeader) {
  const auto cause_after = [](auto send) {
    PacketGate gate(limits());
    for (int k = 1; k <= 100; ++k) gate.take(packet(k, k * kDt, 0.0), k * kDt);
    RemoteCause cause = RemoteCause::kNone;
    int k = 100;
    while (cause == RemoteCause::kNone && k < 1000) {
      ++k;
      send(gate, k);
      cause = gate.check(k * kDt);
    }
    EXPECT_NEAR(k, 301, 1);
    return cause;
  };
  EXPECT_EQ(cause_after([](PacketGate&, int) {}), RemoteCause::kSilent);
  EXPECT_EQ(cause_after([](PacketGate& gate, int k) {
              EXPECT_FALSE(gate.take(packet(k % 100, (k % 100) * kDt, 0.0), k * kDt));
            }),
            RemoteCause::kReplayed);
  EXPECT_EQ(cause_after([](PacketGate& gate, int k) {
              EXPECT_FALSE(gate.take(packet(k, 100 * kDt, 0.0), k * kDt));
            }),
            RemoteCause::kFrozen);
}

TEST(PacketGate, PacketsOfAnEarlierEngagementAreNotUsed) {
  PacketGate gate(limits());
  gate.take(packet(1, 0.001, 0.0, 1), 0.001);
  gate.take(packet(2, 0.002, 0.0, 2), 0.002);
  EXPECT_FALSE(gate.take(packet(3, 0.003, 0.3, 1), 0.003));
  EXPECT_EQ(gate.newest().engagement, 2U);
}

// Follows `wanted` for a second; checks speed and acceleration in every period.
double end_of(double wanted, RemoteCause& seen) {
  const TargetLimiter limiter(limits(), MachineImpedance{}, kDt);
  PortVector x = PortVector::Zero(1), v = x;
  for (int k = 0; k < 3000; ++k) {
    RemoteCause cause = RemoteCause::kNone;
    const RemoteTarget target = limiter.step(
        {PortVector::Constant(1, wanted), PortVector::Zero(1), PortVector::Zero(1)}, x, v, cause);
    const double speed = (target.x[0] - x[0]) / kDt;
    EXPECT_LE(std::abs(speed), 0.4 + 1e-9);
    EXPECT_LE(std::abs(speed - v[0]), 5.0 * kDt + 1e-9);
    EXPECT_LE(std::abs(target.x[0]), 0.5 + 1e-9);
    if (k == 500) seen = cause;
    x = target.x;
    v[0] = speed;
  }
  return x[0];
}

TEST(TargetLimiter, ReachesWhatIsWantedWithinSpeedAccelerationAndRange) {
  RemoteCause cause = RemoteCause::kNone;
  EXPECT_NEAR(end_of(0.3, cause), 0.3, 1e-6);
  EXPECT_EQ(cause, RemoteCause::kSpeed);
  EXPECT_NEAR(end_of(2.0, cause), 0.5, 1e-6);
  EXPECT_NEAR(end_of(-2.0, cause), -0.5, 1e-6);
}

TEST(TargetLimiter, LetsThroughWhatIsWithinLimits) {
  const TargetLimiter limiter(limits(), MachineImpedance{}, kDt);
  PortVector x = PortVector::Zero(1), v = x;
  for (int k = 1; k < 1000; ++k) {
    RemoteCause cause = RemoteCause::kNone;
    const double wanted = 0.1 * (1.0 - std::cos(2.0 * k * kDt));
    const double speed = 0.2 * std::sin(2.0 * k * kDt);
    const RemoteTarget target = limiter.step(
        {PortVector::Constant(1, wanted), PortVector::Constant(1, speed), PortVector::Zero(1)}, x,
        v, cause);
    EXPECT_NEAR(target.x[0], wanted, 1e-15);
    EXPECT_EQ(cause, RemoteCause::kNone);
    v = (target.x - x) / kDt;
    x = target.x;
  }
}

TEST(TargetLimiter, BoundsTheAddedForce) {
  const TargetLimiter limiter(limits(), MachineImpedance{}, kDt);
  const PortVector zero = PortVector::Zero(1);
  RemoteCause cause = RemoteCause::kNone;
  EXPECT_EQ(limiter.step({zero, zero, PortVector::Constant(1, -90.0)}, zero, zero, cause).f[0],
            -20.0);
  EXPECT_EQ(cause, RemoteCause::kForce);
}

// A leader whose positions are honest and whose velocities and forces are not.
TEST(TargetLimiter, VelocitiesAndForcesPushTheMachineNeitherFarNorOutOfItsRange) {
  const MachineImpedance machine;
  const TargetLimiter limiter(limits(), machine, kDt);
  for (const double x : {0.0, 0.5}) {
    for (const double v : {-1e3, 1e3}) {
      for (const double f : {-20.0, 0.0, 20.0}) {
        RemoteCause cause = RemoteCause::kNone;
        const PortVector at = PortVector::Constant(1, x), zero = PortVector::Zero(1);
        const RemoteTarget target = limiter.step(
            {at, PortVector::Constant(1, v), PortVector::Constant(1, f)}, at, zero, cause);
        EXPECT_EQ(target.x[0], x);
        const double rest = x + (machine.damping * target.v[0] + target.f[0]) / machine.stiffness;
        EXPECT_LE(std::abs(target.v[0]), 0.25);
        EXPECT_LE(std::abs(rest - x), 0.25 * machine.damping / machine.stiffness + 2e-3 + 1e-9);
        EXPECT_LE(rest, 0.5 + 1e-9);
      }
    }
  }
}

TEST(RemoteHalf, WithoutAMeasurementHoldsUntilTheNextEngagement) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RemoteHalf half({.kind = MethodKind::kPositionForce}, {}, limits(), kDt);
  MachineState machine = {PortVector::Constant(1, nan), PortVector::Zero(1), PortVector::Zero(1)};
  RemotePacket answer;
  RemoteTarget target;
  std::uint64_t k = 0;
  const auto play = [&](int periods, std::uint32_t engagement, double x) {
    for (int i = 0; i < periods; ++i) {
      ++k;
      half.receive(packet(k, static_cast<double>(k) * kDt, x, engagement),
                   static_cast<double>(k) * kDt);
      target = half.step(static_cast<double>(k) * kDt, machine, answer);
    }
  };
  play(5, 1, 0.0);
  EXPECT_EQ(answer.cause, RemoteCause::kNotFinite) << "from the first period on";
  machine.x[0] = 0.1;
  play(100, 1, 0.2);
  EXPECT_EQ(answer.cause, RemoteCause::kNotFinite) << "it waits for the clutch";
  EXPECT_NEAR(target.x[0], 0.1, 1e-9) << "but holds where it is";
  play(2, 0, 0.1);
  play(500, 2, 0.2);
  EXPECT_EQ(answer.cause, RemoteCause::kNone);
  EXPECT_NEAR(target.x[0], 0.2, 1e-6);
}

TEST(RemoteHalf, ComesToRestAndHoldsWhenTheLeaderFallsSilent) {
  RemoteHalf half({.kind = MethodKind::kPositionForce}, {}, limits(), kDt);
  MachineState machine = {PortVector::Zero(1), PortVector::Zero(1), PortVector::Zero(1)};
  RemotePacket answer;
  RemoteTarget target;
  double x_silent = 0.0;
  for (int k = 1; k < 1000; ++k) {
    if (k <= 500) half.receive(packet(k, k * kDt, 3e-4 * k), k * kDt);
    target = half.step(k * kDt, machine, answer);
    machine.x = target.x;
    if (k == 701) x_silent = target.x[0];
    if (k > 702) {
      EXPECT_EQ(answer.cause, RemoteCause::kSilent);
    }
  }
  EXPECT_NEAR(target.x[0], x_silent, 0.4 * 0.4 / (2.0 * 5.0));
  EXPECT_EQ(target.v[0], 0.0);
}

}  // namespace
}  // namespace hg::teleoperation
