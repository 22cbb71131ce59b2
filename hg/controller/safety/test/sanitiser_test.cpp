#include "hg/controller/safety/sanitiser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include "hg/controller/safety/test/test_device.h"

namespace hg::safety {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLimit = 2.0, kMargin = 0.005, kSpeed = 3.0, kBraking = 30.0;
constexpr double kPeak = 100.0, kRotor = 0.6;

constexpr double kGantrySpeed = 1.5;

DeviceModel device(const std::string& slides = "pprrrrrr") {
  DeviceModel device = device_with(
      slides, {.q_min = -kLimit, .q_max = kLimit, .dq_max = kSpeed, .ddq_max = kBraking / 1.5});
  device.actuators.assign(6, {.rotor_inertia = kRotor, .torque_max = kPeak});
  return device;
}

// A torque-controlled device at rest in the middle of everything.
struct Bench {
  Sanitiser sanitiser;
  RobotState robot;
  VectorM q_before = VectorM::Zero(6), tau_before = VectorM::Zero(6);
  bool was_on = true;
  CommandFrame command;
  Sanitised result;

  explicit Bench(bool has_torques = true, bool is_strict = false)
      : sanitiser({.is_strict = is_strict, .torque_rise = 2e-3}, device(), kGantrySpeed) {
    robot.q_m = robot.dq_m = VectorM::Zero(6);
    robot.q_p = robot.dq_p = VectorP::Zero(2);
    command.enable = true;
    command.q_m = command.dq_m = command.ddq_m = VectorM::Zero(6);
    command.dq_p = VectorP::Zero(2);
    if (!has_torques) return;
    robot.tau_m = command.tau_m = VectorM::Zero(6);
  }
  void step() {
    result = sanitiser.step(
        {.robot = robot, .was_on = was_on, .q_before = q_before, .tau_before = tau_before},
        command);
  }
  double torque_after(double q, double dq, double hold, double tau) {
    robot.q_m[2] = q;
    robot.dq_m[2] = dq;
    robot.tau_m[2] = hold;
    command.tau_m[2] = tau_before[2] = tau;
    step();
    return command.tau_m[2];
  }
};

bool is_same(const CommandFrame& a, const CommandFrame& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), sizeof(double) * x.size()) == 0;
  };
  return same(a.q_m, b.q_m) && same(a.dq_m, b.dq_m) && same(a.ddq_m, b.ddq_m) &&
         same(a.tau_m, b.tau_m) && same(a.dq_p, b.dq_p) && a.enable == b.enable;
}

TEST(Sanitiser, CutsWhatPushesOnBeyondALimitDownToTheTorqueThatHolds) {
  Bench bench;
  EXPECT_EQ(bench.torque_after(kLimit + 0.004, 0.0, 20.0, 50.0), 50.0) << "within the margin";
  EXPECT_EQ(bench.result.changed, 0u);
  EXPECT_EQ(bench.torque_after(kLimit + 0.006, 0.0, 20.0, 50.0), 20.0);
  EXPECT_EQ(bench.result.changed, 1u << 2);
  EXPECT_EQ(bench.torque_after(kLimit + 0.006, 0.0, 20.0, -50.0), -50.0) << "back is allowed";
  EXPECT_EQ(bench.torque_after(-kLimit - 0.006, 0.0, -5.0, -30.0), -5.0);
  Bench strict(true, true);
  EXPECT_EQ(strict.torque_after(kLimit + 0.006, 0.0, 20.0, 50.0), 0.0);
}

TEST(Sanitiser, TheMarginOfASlideIsItsOwn) {
  Bench bench;
  bench.sanitiser =
      Sanitiser({.slide_margin = 2e-3, .torque_rise = 2e-3}, device("pprrprrr"), kGantrySpeed);
  EXPECT_EQ(bench.torque_after(kLimit + 0.0019, 0.0, 20.0, 50.0), 50.0);
  EXPECT_EQ(bench.torque_after(kLimit + 0.0021, 0.0, 20.0, 50.0), 20.0);
}

TEST(Sanitiser, MakesAJointBrakeThatWouldNotStopInTime) {
  Bench bench;
  const double distance = 0.05;
  const double fastest = std::sqrt(2.0 * kBraking * (distance + kMargin));
  const double q = kLimit - distance;
  bench.was_on = false;
  EXPECT_EQ(bench.torque_after(q, 0.99 * fastest, 10.0, 50.0), 50.0);
  EXPECT_EQ(bench.torque_after(q, 1.01 * fastest, 10.0, 50.0), 10.0 - kRotor * kBraking);
  EXPECT_EQ(bench.torque_after(-q, -1.01 * fastest, 10.0, -50.0), 10.0 + kRotor * kBraking);
  EXPECT_EQ(bench.torque_after(q, -1.01 * fastest, 10.0, 50.0), 50.0) << "it moves away";
}

TEST(Sanitiser, CutsWhatAcceleratesAJointThatIsTooFast) {
  Bench bench;
  EXPECT_EQ(bench.torque_after(0.0, 1.04 * kSpeed, 5.0, 50.0), 50.0);
  EXPECT_EQ(bench.torque_after(0.0, 1.06 * kSpeed, 5.0, 50.0), 5.0);
  EXPECT_EQ(bench.torque_after(0.0, 1.06 * kSpeed, 5.0, -50.0), -50.0) << "it brakes";
  EXPECT_EQ(bench.torque_after(0.0, -1.06 * kSpeed, 5.0, -50.0), 5.0);
}

TEST(Sanitiser, LimitsTorquesAndTheirGrowth) {
  Bench bench;
  bench.was_on = false;
  EXPECT_EQ(bench.torque_after(0.0, 0.0, 0.0, 130.0), kPeak);
  EXPECT_EQ(bench.torque_after(0.0, 0.0, 0.0, -130.0), -kPeak);
  bench.was_on = true;
  bench.robot.tau_m[2] = 20.0;
  bench.robot.dq_m.setZero();
  const auto after = [&](double before, double tau) {
    bench.tau_before[2] = before;
    bench.command.tau_m[2] = tau;
    bench.step();
    return bench.command.tau_m[2];
  };
  EXPECT_EQ(after(30.0, 90.0), 80.0) << "half the peak torque in a period";
  EXPECT_EQ(after(30.0, 75.0), 75.0);
  EXPECT_EQ(after(90.0, 20.0), 20.0) << "to the torque that holds at once";
  EXPECT_EQ(after(90.0, -60.0), 20.0) << "and not beyond";
}

TEST(Sanitiser, LimitsTheGantry) {
  Bench bench;
  bench.command.dq_p << 1.6, -9.0;
  bench.step();
  EXPECT_EQ(bench.command.dq_p[0], 1.5);
  EXPECT_EQ(bench.command.dq_p[1], -1.5);
  EXPECT_EQ(bench.result.changed, 3u << 16);
  bench.robot.q_p << 1.4, -1.41;
  bench.command.dq_p << 0.2, -0.2;
  bench.step();
  EXPECT_TRUE(bench.command.dq_p.isZero());
  bench.command.dq_p << -0.2, 0.2;
  bench.step();
  EXPECT_EQ(bench.result.changed, 0u);
  EXPECT_EQ(bench.command.dq_p[0], -0.2);
}

TEST(Sanitiser, DisablesWhatIsNotFinite) {
  Bench bench;
  bench.command.q_m.setConstant(0.3);
  bench.command.tau_m[1] = kNan;
  bench.step();
  EXPECT_EQ(bench.result.fault.code, FaultCode::kCommandNotFinite);
  EXPECT_EQ(bench.result.fault.index, 19);
  EXPECT_FALSE(bench.command.enable);
  EXPECT_TRUE(bench.command.tau_m.isZero() && bench.command.dq_p.isZero());
  EXPECT_EQ(bench.command.q_m[0], 0.3);
  Bench second;
  second.command.dq_p[1] = kInfinity;
  second.step();
  EXPECT_EQ(second.result.fault.index, 25);
  EXPECT_FALSE(second.command.enable);
}

TEST(Sanitiser, KeepsPositionsInTheirRangeAndWithinReach) {
  Bench bench(false);
  bench.command.q_m[1] = bench.q_before[1] = kLimit + 0.01;
  bench.command.dq_m[1] = 0.1;
  bench.step();
  EXPECT_EQ(bench.command.q_m[1], kLimit + kMargin);
  EXPECT_EQ(bench.command.dq_m[1], 0.0);
  EXPECT_EQ(bench.result.changed, 1u << 1);
  Bench outside(false);  // a device that stands outside may stay there
  outside.robot.q_m[1] = outside.q_before[1] = outside.command.q_m[1] = kLimit + 0.1;
  outside.step();
  EXPECT_EQ(outside.command.q_m[1], kLimit + 0.1);
  Bench jump(false);
  jump.command.q_m[0] = 0.5;
  jump.step();
  EXPECT_NEAR(jump.command.q_m[0], 1.05 * kSpeed * 1e-3, 1e-12);
  jump.robot.q_m[3] = 0.4;  // back to where the device is
  jump.q_before[3] = 0.9;
  jump.command.q_m[3] = 0.4;
  jump.step();
  EXPECT_EQ(jump.command.q_m[3], 0.4);
}

// Random states and commands, many of them beyond everything.
class SanitiserProperties : public ::testing::TestWithParam<bool> {
 protected:
  double number(double largest) {
    return std::uniform_real_distribution<double>(-largest, largest)(random_);
  }
  void draw(Bench& bench) {
    for (int i = 0; i < 6; ++i) {
      const bool is_wild = random_() % 2 == 0;
      bench.robot.q_m[i] = number(is_wild ? 2.1 : 1.0);
      bench.robot.dq_m[i] = number(is_wild ? 4.0 : 1.0);
      bench.q_before[i] = bench.robot.q_m[i] + number(0.005);
      bench.command.q_m[i] = bench.q_before[i] + number(is_wild ? 0.1 : 0.003);
      bench.command.dq_m[i] = number(4.0);
      if (!GetParam()) continue;
      bench.robot.tau_m[i] = number(is_wild ? 120.0 : 60.0);
      bench.tau_before[i] = number(100.0);
      bench.command.tau_m[i] = bench.tau_before[i] + number(is_wild ? 100.0 : 30.0);
    }
    for (int i = 0; i < 2; ++i) {
      bench.robot.q_p[i] = number(1.5);
      bench.command.dq_p[i] = number(2.0);
    }
    bench.was_on = random_() % 4 != 0;
  }

  std::mt19937 random_{20240901};
};

TEST_P(SanitiserProperties, DoingItTwiceChangesNothingMore) {
  int changed = 0;
  for (int k = 0; k < 20000; ++k) {
    Bench bench(GetParam());
    draw(bench);
    const CommandFrame before = bench.command;
    bench.step();
    const CommandFrame once = bench.command;
    EXPECT_EQ(bench.result.changed != 0, !is_same(before, once)) << k;
    if (bench.result.changed != 0) ++changed;
    bench.step();
    ASSERT_TRUE(is_same(once, bench.command)) << k;
    ASSERT_EQ(bench.result.changed, 0u) << k;
  }
  EXPECT_GT(changed, 5000);
}

TEST_P(SanitiserProperties, WhatIsFineStaysAsItIs) {
  for (int k = 0; k < 20000; ++k) {
    Bench bench(GetParam());
    for (int i = 0; i < 6; ++i) {
      bench.robot.q_m[i] = number(1.9);
      const double room = kLimit - std::abs(bench.robot.q_m[i]);
      bench.robot.dq_m[i] = number(std::min(kSpeed, std::sqrt(2.0 * kBraking * room)));
      bench.q_before[i] = bench.robot.q_m[i] + number(0.002);
      bench.command.q_m[i] = bench.q_before[i] + number(0.003);
      bench.command.dq_m[i] = number(kSpeed);
      bench.command.ddq_m[i] = number(50.0);
      if (!GetParam()) continue;
      bench.robot.tau_m[i] = number(60.0);
      bench.tau_before[i] = number(50.0);
      bench.command.tau_m[i] = bench.tau_before[i] + number(49.0);
    }
    bench.robot.q_p << number(1.39), number(1.39);
    bench.command.dq_p << number(1.5), number(1.5);
    const CommandFrame before = bench.command;
    bench.step();
    ASSERT_TRUE(is_same(before, bench.command)) << k;
    ASSERT_EQ(bench.result.changed, 0u) << k;
  }
}

TEST_P(SanitiserProperties, OutsideTheBrakingZoneATorqueOnlyComesNearerToTheOneThatHolds) {
  if (!GetParam()) GTEST_SKIP() << "no torques";
  for (int k = 0; k < 20000; ++k) {
    Bench bench;
    draw(bench);
    const CommandFrame before = bench.command;
    bench.step();
    for (int i = 0; i < 6; ++i) {
      const double hold = std::clamp(bench.robot.tau_m[i], -kPeak, kPeak);
      const double tau = before.tau_m[i], limited = bench.command.tau_m[i];
      const double q = bench.robot.q_m[i], dq = bench.robot.dq_m[i];
      ASSERT_LE(std::abs(limited), kPeak);
      const double room = kLimit + kMargin - (dq > 0.0 ? q : -q);
      if (dq * dq > 2.0 * kBraking * std::max(0.0, room)) {
        // braking, as far as the torque may change at once
        const double brake = hold - std::copysign(kRotor * kBraking, dq);
        if (!bench.was_on && std::abs(brake) <= kPeak) {
          ASSERT_LE((limited - brake) * dq, 1e-9) << k << " " << i;
        }
        continue;
      }
      ASSERT_LE(std::abs(limited - hold), std::abs(tau - hold) + 1e-12) << k << " " << i;
      ASSERT_GE((limited - hold) * (tau - hold), 0.0) << k << " " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Drives, SanitiserProperties, ::testing::Values(true, false),
                         [](const auto& drives) { return drives.param ? "Torques" : "Positions"; });

}  // namespace
}  // namespace hg::safety
