#include "hg/teleoperation/machine.h"

#include <gtest/gtest.h>

#include "hg/teleoperation/remote_side.h"

namespace hg::teleoperation {
namespace {

constexpr double kDt = 1e-3;

SimulatedMachineConfig arm(const StopRules& stops) {
  return {.x_start = PortVector::Zero(1), .ranges = {{-0.2, 0.2}}, .stops = stops};
}

// Whether a machine stops that is led to `way` with speed `v`.
bool stops(const StopRules& rules, double way, double v, double wall = 1.0) {
  SimulatedMachineConfig config = arm(rules);
  config.walls = {{.normal = PortVector::Constant(1, -1.0), .offset = -wall}};
  SimulatedMachine machine(config, kDt);
  MachineState state;
  RemoteTarget target = {PortVector::Zero(1), PortVector::Constant(1, v), PortVector::Zero(1)};
  while (target.x[0] < way) {
    target.x[0] += v * kDt;
    machine.write(target);
  }
  for (int k = 0; k < 200; ++k) {
    target.v.setZero();
    machine.write(target);
  }
  machine.read(state);
  return state.has_stopped;
}

TEST(SimulatedMachine, StopsByItsOwnRulesOnly) {
  EXPECT_FALSE(stops({}, 0.5, 1.0)) << "it has none";
  EXPECT_TRUE(stops({.beyond = 0.01}, 0.22, 0.1));
  EXPECT_FALSE(stops({.beyond = 0.01}, 0.205, 0.1));
  EXPECT_TRUE(stops({.speed = 0.5}, 0.1, 0.6));
  EXPECT_FALSE(stops({.speed = 0.5}, 0.1, 0.3));
  EXPECT_TRUE(stops({.acceleration = 200.0}, 0.1, 0.6)) << "600 m/s^2 at the begin";
  EXPECT_TRUE(stops({.force = 20.0}, 0.15, 0.1, 0.1));
  EXPECT_FALSE(stops({.force = 20.0}, 0.102, 0.1, 0.1));
}

TEST(SimulatedMachine, InAProtectiveStopHoldsUntilTheLeaderLetsGo) {
  SimulatedMachineConfig config = arm({.speed = 0.5});
  const LimiterConfig limiter = {.axes = {{.range = {-0.2, 0.2}, .v_max = 2.0, .a_max = 100.0}}};
  SimulatedRemote remote({.kind = MethodKind::kPositionForce}, limiter, config, kDt);
  const PortVector zero = PortVector::Zero(1);
  LeaderPacket packet = {
      .engagement = 1, .x = zero, .v = zero, .f = zero, .wave = zero, .energy = zero};
  RemotePacket answer;
  double now_s = 0.0;
  const auto play = [&](int periods, double v) {
    for (int k = 0; k < periods; ++k) {
      now_s += kDt;
      ++packet.sequence;
      packet.sent_s = now_s;
      packet.x[0] += v * kDt;
      packet.v[0] = v;
      remote.send(packet, now_s);
      remote.step(now_s);
      ASSERT_TRUE(remote.receive(answer));
    }
  };
  play(100, 0.1);
  EXPECT_EQ(answer.cause, RemoteCause::kNone);
  play(100, 1.0);
  EXPECT_EQ(answer.cause, RemoteCause::kStopped);
  EXPECT_TRUE(holds(answer.cause));
  play(500, 0.0);
  const double held = remote.truth()->x[0];
  EXPECT_EQ(answer.cause, RemoteCause::kStopped) << "it waits";
  play(100, -0.1);
  EXPECT_NEAR(remote.truth()->x[0], held, 1e-3) << "and does not follow";
  packet.engagement = 0;
  play(10, 0.0);
  EXPECT_FALSE(remote.truth()->has_stopped);
  EXPECT_NEAR(remote.truth()->x[0], held, 1e-3);
  packet.engagement = 2;
  packet.x = answer.x_target;
  play(300, 0.1);
  EXPECT_NEAR(remote.truth()->x[0], held + 0.03, 2e-3) << "led again";
}

}  // namespace
}  // namespace hg::teleoperation
