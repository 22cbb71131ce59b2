#include "hg/controller/safety/monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "hg/controller/safety/test/test_device.h"
#include "hg/core/fields.h"

namespace hg::safety {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

SensorFrame good_sensors() {
  SensorFrame sensors;
  sensors.sequence = 7;
  sensors.q_m = VectorM::Zero(6);
  sensors.dq_m = VectorM::Zero(6);
  sensors.q_p = VectorP::Zero(2);
  return sensors;
}

MonitorConfig config() { return {.frozen_samples = 20}; }

// One sum of joints and one box follow the joints in the catalogue.
DeviceModel device(const std::string& slides = "pprrrrrr") {
  DeviceModel device =
      device_with(slides, {.q_min = -2.0, .q_max = 2.0, .dq_max = 3.0, .ddq_max = 20.0});
  device.actuators.assign(6, {.rotor_inertia = 0.6,
                              .stiffness = 10000.0,
                              .coulomb_friction = 5.0,
                              .load_friction = 0.0,
                              .stiction = 1.0,
                              .torque_max = 100.0,
                              .speed_full_torque = 2.0,
                              .speed_no_load = 4.0});
  device.virtual_joints.resize(1);
  device.cartesian_limits.resize(1);
  return device;
}

TEST(CheckSensors, AFaultThatTheDriverReportsComesFirst) {
  const Fault not_finite = {.code = FaultCode::kSensorNotFinite};
  SensorFrame sensors = good_sensors();
  sensors.driver_fault = FaultCode::kDeviceSilent;
  EXPECT_EQ(check_sensors(sensors, 6, not_finite).code, FaultCode::kDeviceSilent);
}

TEST(CheckSensors, SeesGapsThenValues) {
  const Fault not_finite = {.code = FaultCode::kSensorNotFinite};
  EXPECT_EQ(check_sensors(good_sensors(), 6, not_finite).code, FaultCode::kSequenceGap);
  EXPECT_EQ(check_sensors(good_sensors(), 7, not_finite).code, FaultCode::kSensorNotFinite);
  EXPECT_EQ(check_sensors(good_sensors(), 7, {}).code, FaultCode::kNone);
}

TEST(CheckSolution, FindsWhatMustNotBeIntegrated) {
  const VectorM ddq_m = VectorM::Zero(6);
  const VectorA ddq_a = VectorA::Zero(2);
  EXPECT_EQ(check_solution(SolverStatus::kSolved, ddq_m, ddq_a).code, FaultCode::kNone);
  EXPECT_EQ(check_solution(SolverStatus::kBudgetSpent, ddq_m, ddq_a).code, FaultCode::kNone);
  EXPECT_EQ(check_solution(SolverStatus::kFailed, ddq_m, ddq_a).code, FaultCode::kSolverFailed);
  VectorA bad_twin = ddq_a;
  bad_twin[1] = kNan;
  EXPECT_EQ(check_solution(SolverStatus::kSolved, ddq_m, bad_twin).code,
            FaultCode::kReferenceNotFinite);
  VectorM bad_joints = ddq_m;
  bad_joints[4] = kInfinity;
  EXPECT_EQ(check_solution(SolverStatus::kSolved, bad_joints, ddq_a).code,
            FaultCode::kReferenceNotFinite);
}

// What estimation and rendering give.
struct Results {
  RobotState robot;
  ReferenceState reference;
  std::array<LimitReport, kMaxLimits> limits{};
  std::array<double, kMaxLimits> passing{};
  double sync_error = 0.0;
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero(), contact_force = Eigen::Vector3d::Zero();

  Rendered rendered() const {
    return {.robot = robot,
            .reference = reference,
            .limits = limits,
            .sync_error = sync_error,
            .v_H = v_H,
            .contact_force = contact_force,
            .passing = passing};
  }
};

// A device that runs and follows its commands, with noise on what has noise.
struct Bench {
  Monitor monitor;
  MonitorState state;
  SensorFrame sensors = good_sensors();
  Results results;
  Watched watched = {.state = SafetyState::kByHand, .dq_p_command = VectorP::Zero(2)};
  MonitorResult verdict;
  int cycles = 0;
  double torque = 0.0;  ///< of joint 0

  explicit Bench(const MonitorConfig& monitor_config = config(),
                 const DeviceModel& model = device(), const MonitoredParts& parts = {})
      : monitor(monitor_config, model, parts) {
    sensors.theta_m = sensors.tau_m = VectorM::Zero(6);
    sensors.temperature_m = VectorM::Constant(6, 40.0);
    results.robot.q_m = results.robot.dq_m = VectorM::Zero(6);
    results.robot.q_p = results.robot.dq_p = VectorP::Zero(2);
    results.reference = {VectorM::Zero(6), VectorM::Zero(6), VectorM::Zero(6)};
    watched.state = SafetyState::kReady;
    step();
    watched.state = SafetyState::kByHand;
    run(3);
    EXPECT_EQ(verdict.fault.code, FaultCode::kNone);
    EXPECT_EQ(verdict.warning.code, FaultCode::kNone);
  }

  void step(bool has_noise = true) {
    sensors.time_s += 1e-3;
    if (state.dq_p_model.size() > 0) sensors.q_p += 1e-3 * state.dq_p_model;
    if (has_noise) {
      ++cycles;
      const double noise = cycles % 2 == 0 ? 1e-6 : -1e-6;
      sensors.w_S.array() += noise;
      sensors.a_S.array() += noise;
      sensors.omega_S.array() += noise;
      for (int i = 0; i < 6; ++i) sensors.tau_m[i] = 1e-4 * cycles + (i == 0 ? torque : 0.0);
    }
    verdict = monitor.watch(sensors, results.rendered(), watched, state);
  }
  void run(int samples) {
    for (int k = 0; k < samples; ++k) step();
  }
  // samples until the fault; -1: none within 2000
  template <typename Change>
  int until_fault(FaultCode code, Change change) {
    for (int k = 1; k <= 2000; ++k) {
      change();
      step();
      if (verdict.fault.code == FaultCode::kNone) continue;
      EXPECT_EQ(verdict.fault.code, code) << to_string(verdict.fault.code);
      return k;
    }
    return -1;
  }
};

// A value that breaks a rule, one that does not, and how many samples it takes.
struct Case {
  FaultCode code;
  const char* name;
  int samples;
  int index;
  double over, under;
  void (*put)(Bench&, double);
  bool warns = true;
};

const Case kCases[] = {
    {FaultCode::kLimitExceeded, "measured joint", 1, 3, 2.031, 2.029,
     [](Bench& b, double x) {
       b.results.robot.q_m[3] = x;
       b.results.reference.q_m[3] = 2.0;
     }},
    {FaultCode::kLimitExceeded, "reference of a joint", 1, 2, -2.031, -2.029,
     [](Bench& b, double x) {
       b.results.reference.q_m[2] = x;
       b.results.robot.q_m[2] = -2.0;
     }},
    {FaultCode::kLimitExceeded, "sum of joints", 1, 6, 0.051, 0.049,
     [](Bench& b, double x) { b.results.limits[6].excess = x; }},
    {FaultCode::kLimitExceeded, "frame", 1, 8, 0.031, 0.029,
     [](Bench& b, double x) { b.results.limits[8].excess = x; }},
    {FaultCode::kLimitNotHeld, "end of a joint", 5, 3, 0.031, 0.029,
     [](Bench& b, double x) { b.results.passing[3] = x; }, false},
    {FaultCode::kLimitNotHeld, "sum of joints ahead", 5, 6, 0.051, 0.049,
     [](Bench& b, double x) { b.results.passing[6] = x; }, false},
    {FaultCode::kLimitNotHeld, "wall", 5, 8, 0.031, 0.029,
     [](Bench& b, double x) { b.results.passing[8] = x; }, false},
    {FaultCode::kSpeedExceeded, "measured speed", 3, 4, -3.31, -3.29,
     [](Bench& b, double x) { b.results.robot.dq_m[4] = x; }},
    {FaultCode::kSpeedExceeded, "speed of the reference", 3, 4, 3.31, 3.29,
     [](Bench& b, double x) { b.results.reference.dq_m[4] = x; }},
    {FaultCode::kAccelerationExceeded, "acceleration", 3, 1, 41.0, 39.0,
     [](Bench& b, double x) { b.results.reference.ddq_m[1] = x; }},
    {FaultCode::kTrackingLost, "tracking", 20, 5, 0.081, 0.079,
     [](Bench& b, double x) { b.results.robot.q_m[5] = -x; }},
    {FaultCode::kSyncLost, "handle and twin", 3, -1, 0.021, 0.019,
     [](Bench& b, double x) { b.results.sync_error = x; }},
    {FaultCode::kJointTorqueExceeded, "torque", 3, 0, 101.0, 99.0,
     [](Bench& b, double x) {
       b.torque = x;
       b.sensors.theta_m[0] = x / 10000.0;
     }},
    {FaultCode::kTorqueUnexplained, "unexplained torque", 20, 4, 10.1, 9.9,
     [](Bench& b, double x) {
       b.watched.unexplained = VectorM::Zero(6);
       b.watched.unexplained[4] = -x;
     }},
    {FaultCode::kTurnUnexplained, "gyroscope", 3, -1, 0.0252, 0.0248,
     [](Bench& b, double x) {
       b.watched.turn = x;
       b.watched.turn_uncertainty = 0.01;
     }},
    {FaultCode::kMotionUnexplained, "accelerometer", 5, -1, 0.152, 0.148,
     [](Bench& b, double x) { b.watched.slip = x; }},
    {FaultCode::kSensorImplausible, "contradiction", 3, 2, 0.0202, 0.0198,
     [](Bench& b, double x) { b.sensors.theta_m[2] = x; }},
    {FaultCode::kWrenchTooLarge, "force", 5, 0, 151.0, 149.0,
     [](Bench& b, double x) { b.sensors.w_S[0] = x; }},
    {FaultCode::kWrenchTooLarge, "torque of the user", 5, 1, -14.1, -13.9,
     [](Bench& b, double x) { b.sensors.w_S[4] = x; }},
    {FaultCode::kTooHot, "temperature", 100, 3, 90.1, 89.9,
     [](Bench& b, double x) { b.sensors.temperature_m[3] = x; }},
    {FaultCode::kBusErrors, "bus", 3, -1, 1.0, 0.0,
     [](Bench& b, double x) { b.sensors.bus_errors = static_cast<std::uint32_t>(x); }, false},
    {FaultCode::kGantryExceeded, "gantry range", 3, 1, -1.4201, -1.4199,
     [](Bench& b, double x) { b.results.robot.q_p[1] = x; }},
    {FaultCode::kGantryExceeded, "gantry speed", 3, 0, 1.66, 1.64,
     [](Bench& b, double x) { b.results.robot.dq_p[0] = b.state.dq_p_model[0] = x; }},
    {FaultCode::kGantryDeviates, "gantry deviation", 10, 0, 0.27, 0.25,
     [](Bench& b, double x) { b.results.robot.dq_p[0] = x; }},
};

TEST(Monitor, EveryRuleActsBeyondItsThresholdAfterItsDebounceAndNotBelow) {
  for (const Case& c : kCases) {
    Bench over;
    EXPECT_EQ(over.until_fault(c.code, [&] { c.put(over, c.over); }), c.samples) << c.name;
    EXPECT_EQ(over.verdict.fault.index, c.index) << c.name;
    EXPECT_GT(over.verdict.fault.value, over.verdict.fault.limit) << c.name;
    Bench under;
    EXPECT_EQ(under.until_fault(c.code, [&] { c.put(under, c.under); }), -1) << c.name;
    EXPECT_EQ(under.verdict.warning.code, c.warns ? c.code : FaultCode::kNone) << c.name;
    EXPECT_FALSE(under.state.is_broken);
  }
}

TEST(Monitor, AGapRestartsTheDebounce) {
  for (const Case& c : kCases) {
    if (c.samples == 1) continue;
    Bench bench;
    for (int k = 0; k < 5; ++k) {
      for (int sample = 1; sample < c.samples; ++sample) {
        c.put(bench, c.over);
        bench.step();
        EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone) << c.name;
      }
      c.put(bench, c.under);
      bench.step();
      EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone) << c.name;
    }
  }
}

TEST(Monitor, NoDebounceIsLongerAtAHigherRateInTime) {
  MonitorConfig deaf = config();
  deaf.clock_tolerance = kInfinity;
  DeviceModel fast = device();
  fast.rate_Hz = 2000.0;
  Bench bench(deaf, fast);
  EXPECT_EQ(
      bench.until_fault(FaultCode::kTrackingLost, [&] { bench.results.robot.q_m[5] = 0.081; }), 40);
}

TEST(Monitor, AJumpIsThreeTimesTheSpeedAndAWholeTurnIsNone) {
  Bench bench;
  bench.sensors.q_m[1] += 8.9e-3;
  bench.sensors.theta_m[1] += 8.9e-3;
  bench.step();
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
  bench.sensors.q_m[1] += 6.28318530717958;
  bench.sensors.theta_m[1] += 8.9e-3;
  bench.step();
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
  bench.sensors.q_m[1] += 9.1e-3;
  bench.step();
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kSensorJump);
  EXPECT_EQ(bench.verdict.fault.index, 1);
  bench.sensors.q_p[1] += 4.6e-3;
  bench.step();
  EXPECT_EQ(bench.verdict.fault.index, 7);
  Monitor::forget(bench.state);
  bench.sensors.q_p[1] += 1.0;
  bench.step();
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone) << "there is nothing to compare with";
}

TEST(Monitor, SeesFrozenSensorsOnlyWhereTheyHaveNoise) {
  const auto freeze = [](Bench& bench, int samples, auto&& spare) {
    for (int k = 0; k < samples; ++k) {
      spare(k);
      bench.step(false);
      if (bench.verdict.fault.code != FaultCode::kNone) return k + 1;
    }
    return -1;
  };
  Bench all;
  EXPECT_EQ(freeze(all, 100, [](int) {}), 21);
  EXPECT_EQ(all.verdict.fault.code, FaultCode::kSensorFrozen);
  // joint torques, wrench, accelerometer, gyroscope: one component alone
  for (const int frozen : {5, 6, 11, 12, 17}) {
    Bench one;
    const auto noise = [&](int k) {
      const auto shake = [&](int first, auto& v) {
        for (int i = 0; i < v.size(); ++i) {
          if (first + i != frozen) v[i] = 1e-3 * k;
        }
      };
      shake(0, one.sensors.tau_m);
      shake(6, one.sensors.w_S);
      shake(12, one.sensors.a_S);
      shake(15, one.sensors.omega_S);
    };
    EXPECT_EQ(freeze(one, 100, noise), 21) << frozen;
    EXPECT_EQ(one.verdict.fault.index, frozen);
  }
  MonitorConfig without = config();
  without.frozen_samples = 0;
  Bench ideal(without);
  EXPECT_EQ(freeze(ideal, 1000, [](int) {}), -1);
}

TEST(Monitor, AClockThatStopsJumpsOrRunsWrongIsSeenAndOneThatJittersIsNot) {
  Bench stops;
  EXPECT_LT(stops.until_fault(FaultCode::kClockWrong, [&] { stops.sensors.time_s -= 1e-3; }), 20);
  Bench jumps;
  jumps.sensors.time_s += 1.0;
  EXPECT_EQ(jumps.until_fault(FaultCode::kClockWrong, [] {}), 3);
  Bench fast;
  EXPECT_GT(fast.until_fault(FaultCode::kClockWrong, [&] { fast.sensors.time_s += 0.3e-3; }), 0);
  Bench jitters;
  int k = 0;
  EXPECT_EQ(jitters.until_fault(FaultCode::kClockWrong,
                                [&] { jitters.sensors.time_s += ++k % 2 == 0 ? 0.3e-3 : -0.3e-3; }),
            -1);
}

// 1e308 s make the mean of the clock's error infinite, and the step back makes it NaN
TEST(Monitor, OneWildTimeStampIsSeenAndTheClockIsWatchedAfterIt) {
  for (const double wild : {1e308, -1e308, 1e12}) {
    Bench bench;
    const double before = bench.sensors.time_s;
    bench.sensors.time_s = wild;
    bench.step();
    bench.sensors.time_s = before + 1e-3;
    EXPECT_GT(bench.until_fault(FaultCode::kClockWrong, [] {}), 0) << wild;
    bench.run(2000);
    EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone) << wild;
    EXPECT_GT(bench.until_fault(FaultCode::kClockWrong, [&] { bench.sensors.time_s -= 1e-3; }), 0)
        << wild;
  }
}

TEST(Monitor, AValueThatCannotBeComputedBreaksItsRule) {
  Bench bench;
  bench.sensors.q_m[2] = bench.sensors.theta_m[2] = 1e308;
  bench.step();
  bench.sensors.q_m[2] = bench.sensors.theta_m[2] = -1e308;  // the difference is infinite
  bench.step();
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kSensorJump);
  bench.sensors.q_m[2] = 1e308;
  EXPECT_TRUE(bench.monitor.has_jumped(bench.sensors, bench.state));
  Bench results;
  EXPECT_GT(results.until_fault(FaultCode::kSyncLost, [&] { results.results.sync_error = kNan; }),
            0);
}

TEST(Monitor, LateCyclesAreForgivenWhenTheyAreFewAndFarBetween) {
  Bench rare;
  int k = 0;
  EXPECT_EQ(rare.until_fault(FaultCode::kCycleOverrun,
                             [&] { rare.watched.late_cycles = ++k % 250 == 0 ? 1 : 0; }),
            -1);
  Bench often;
  k = 0;
  const int until = often.until_fault(FaultCode::kCycleOverrun,
                                      [&] { often.watched.late_cycles = ++k % 50 == 0 ? 1 : 0; });
  EXPECT_GT(until, 250);
  EXPECT_LT(until, 500);
  EXPECT_EQ(often.verdict.fault.index, 1);
  Bench row;
  EXPECT_EQ(row.until_fault(FaultCode::kCycleOverrun, [&] { row.watched.late_cycles = 1; }), 3);
  Bench many;
  EXPECT_EQ(many.until_fault(FaultCode::kCycleOverrun, [&] { many.watched.late_cycles = 3; }), 1);
}

TEST(Monitor, AReferenceThatHasToComeBackAgainAndAgainIsLostToo) {
  Bench bench;
  bench.results.robot.q_m[4] = -0.007;
  bench.watched.pulled_back = VectorM::Zero(6);
  bench.watched.pulled_back[4] = 0.001;  // 1 rad/s that the joint does not follow
  EXPECT_NEAR(bench.until_fault(FaultCode::kTrackingLost, [] {}), 73 + 20, 2);
  Bench brief;
  int k = 0;
  EXPECT_EQ(brief.until_fault(FaultCode::kTrackingLost,
                              [&] {
                                brief.watched.pulled_back = VectorM::Zero(6);
                                if (++k < 50) brief.watched.pulled_back[4] = 0.001;
                              }),
            -1);
}

TEST(Monitor, PositionsReachedWithoutPowerAllowOnlyMovesBack) {
  Bench bench;
  bench.watched.state = SafetyState::kFault;
  bench.results.robot.q_m[0] = bench.results.reference.q_m[0] = 2.5;
  bench.results.robot.dq_m[1] = 5.0;
  bench.results.robot.q_p[0] = 1.6;
  bench.results.robot.dq_p[1] = 3.0;
  bench.run(200);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
  bench.results.robot.dq_m[1] = bench.results.robot.dq_p[1] = 0.0;
  bench.step();
  bench.watched.state = SafetyState::kByHand;
  bench.run(200);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
  bench.results.robot.q_m[0] = bench.results.reference.q_m[0] = 2.3;
  bench.results.robot.q_p[0] = 1.5;
  bench.run(2);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
  bench.results.robot.q_m[0] = bench.results.reference.q_m[0] = 2.34;
  bench.step();
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kLimitExceeded);
  bench.results.robot.q_m[0] = bench.results.reference.q_m[0] = 2.3;
  bench.results.robot.q_p[0] = 1.53;
  bench.run(3);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kGantryExceeded);
}

TEST(Monitor, TheTwistOfALoadedSpringIsNoContradictionAndItsAbsenceIsOne) {
  Bench bench;
  bench.torque = 90.0;  // twists the spring by 9 mrad
  bench.sensors.theta_m[0] = 0.009;
  bench.run(10);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
  bench.sensors.theta_m[0] = -0.0115;
  bench.run(3);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kSensorImplausible);
}

TEST(Monitor, SlidesAndTurningGantriesHaveTolerancesOfTheirOwn) {
  MonitorConfig other = config();
  other.slide_tolerance = 0.01;
  other.slide_tracking_tolerance = 0.005;
  other.turn_tolerance = 0.2;
  other.turn_deviation = 0.1;
  const auto until = [&](FaultCode code, auto put) {
    Bench bench(other, device("rrrrrprr"));
    return bench.until_fault(code, [&] { put(bench); });
  };
  for (const double excess : {0.009, 0.011}) {
    EXPECT_EQ(until(FaultCode::kLimitExceeded,
                    [&](Bench& b) {
                      b.results.robot.q_m[3] = b.results.reference.q_m[3] = 2.0 + excess;
                    }),
              excess < 0.01 ? -1 : 1);
    EXPECT_EQ(
        until(FaultCode::kTrackingLost, [&](Bench& b) { b.results.robot.q_m[3] = 0.5 * excess; }),
        excess < 0.01 ? -1 : 20);
    EXPECT_EQ(until(FaultCode::kGantryExceeded,
                    [&](Bench& b) { b.results.robot.q_p[1] = 1.4 + 20.0 * excess; }),
              excess < 0.01 ? -1 : 3);
    EXPECT_EQ(until(FaultCode::kGantryDeviates,
                    [&](Bench& b) { b.results.robot.dq_p[1] = 11.5 * excess; }),
              excess < 0.01 ? -1 : 10);
  }
}

TEST(Monitor, BelowALimitItMayOnlyMoveBackToo) {
  Bench bench;
  const auto put = [&](double q) {
    bench.results.robot.q_m[0] = bench.results.reference.q_m[0] = q;
  };
  bench.watched.state = SafetyState::kReady;
  put(-2.5);
  bench.step();
  bench.watched.state = SafetyState::kByHand;
  put(-2.3);
  bench.run(2);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
  put(-2.34);
  bench.step();
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kLimitExceeded);
}

TEST(Monitor, TheSafeSpeedAppliesOnlyWhileTheHandleIsNotHeld) {
  Bench bench;
  bench.results.v_H = {0.2, 0.16, 0.0};
  bench.run(10);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
  bench.watched.state = SafetyState::kAutonomous;
  EXPECT_EQ(bench.until_fault(FaultCode::kSafeSpeedExceeded, [] {}), 3);
  bench.results.v_H.setZero();
  bench.step();
  bench.results.robot.dq_p << 0.2, -0.16;
  EXPECT_EQ(bench.until_fault(FaultCode::kSafeSpeedExceeded,
                              [&] { bench.state.dq_p_model = bench.results.robot.dq_p; }),
            3);
}

// A motor of the bench that accelerates as `share` of its torque makes it, against its friction.
struct Motor {
  double dtheta = 0.0;
  void step(Bench& bench, double command, double share, double spring) {
    bench.watched.tau_m = VectorM::Zero(6);
    bench.watched.tau_m[2] = command;
    const double friction = 4.0 * std::tanh(dtheta / 0.01);
    dtheta += 1e-3 * (share * command - spring - friction) / 0.6;
    bench.results.robot.dtheta_m = bench.results.robot.tau_m = VectorM::Zero(6);
    bench.results.robot.dtheta_m[2] = dtheta;
    bench.results.robot.tau_m[2] = spring;
    bench.step();
  }
};

TEST(Monitor, AMotorThatFollowsItsCommandRaisesNoFault) {
  Bench bench;
  Motor motor;
  for (int k = 0; k < 3000; ++k) {
    const double wave = std::sin(2e-3 * std::numbers::pi * 2.0 * k);
    motor.step(bench, 40.0 + 15.0 * wave, 1.0, 40.0);
    ASSERT_EQ(bench.verdict.fault.code, FaultCode::kNone) << k;
  }
  EXPECT_GT(std::abs(motor.dtheta), 0.1);
}

TEST(Monitor, AMotorThatGivesNoTorqueIsNoticedBeforeItHasMovedFar) {
  Bench bench;
  Motor motor;
  int k = 0;
  double moved = 0.0;
  for (; k < 300 && bench.verdict.fault.code == FaultCode::kNone; ++k) {
    motor.step(bench, 30.0, 0.0, 6.0);  // 30 Nm, of which the spring would carry 6
    moved += 1e-3 * motor.dtheta;
  }
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kMotorDeviates);
  EXPECT_EQ(bench.verdict.fault.index, 2);
  EXPECT_GE(k, 50);
  EXPECT_LT(k, 120);
}

TEST(Monitor, WhatBrakingDoesNotExplainStopsNothing) {
  Bench bench;
  bench.watched.unexplained = VectorM::Constant(6, 50.0);
  bench.watched.state = SafetyState::kToReady;
  bench.run(200);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone);
}

TEST(Monitor, AGantryThatSlowlyComesAwayFromItsDriveModelDeviates) {
  Bench bench;  // its encoder counts 0.1 m/s while it should stand
  const int until =
      bench.until_fault(FaultCode::kGantryDeviates, [&] { bench.sensors.q_p[0] += 1e-3 * 0.1; });
  EXPECT_NEAR(until, 10 + 300 + 25, 10);  // debounce, and 0.03 m of which some is forgotten
  Bench slow;
  EXPECT_EQ(
      slow.until_fault(FaultCode::kGantryDeviates, [&] { slow.sensors.q_p[0] += 1e-3 * 0.01; }),
      -1);
}

TEST(Monitor, TheGantryFollowsItsDriveModel) {
  Bench bench;
  double speed = 0.0;
  bench.watched.dq_p_command[0] = 1.2;
  EXPECT_EQ(bench.until_fault(FaultCode::kGantryDeviates,
                              [&] {
                                speed +=
                                    1e-3 * drive_acceleration(DriveModel{.lag = 0.06}, speed, 1.2);
                                bench.results.robot.dq_p[0] = speed;
                              }),
            -1);
  Bench stuck;
  stuck.watched.dq_p_command[0] = 1.2;
  const int until = stuck.until_fault(FaultCode::kGantryDeviates, [] {});
  EXPECT_GT(until, 100);
  EXPECT_LT(until, 140);
}

// A joint and an axis of the gantry that are being stopped, from a speed of 1.
struct BrakingBench : Bench {
  double reference = 1.0;

  BrakingBench() {
    results.reference.dq_m[2] = results.robot.dq_m[2] = reference;
    results.robot.dq_p[1] = state.dq_p_model[1] = reference;
    watched.state = SafetyState::kToFault;
  }
  // one period; the axes are faster than their ramps by so much
  void brake(double joint_excess, double gantry_excess) {
    reference = std::max(0.0, reference - 2e-3);
    results.robot.dq_m[2] = reference + joint_excess;
    // its acceleration is the ramp; the reference itself is brought back to the device
    results.reference.ddq_m[2] = reference > 0.0 ? -2.0 : 0.0;
    results.reference.dq_m[2] = state.is_stopping ? results.robot.dq_m[2] : reference;
    results.robot.q_m[2] += 1e-3 * results.robot.dq_m[2];
    results.reference.q_m[2] = results.robot.q_m[2];
    results.robot.dq_p[1] = state.dq_p_model[1] + gantry_excess;
    results.robot.q_p[1] += 1e-3 * results.robot.dq_p[1];
    sensors.q_p[1] = results.robot.q_p[1] - 1e-3 * state.dq_p_model[1];  // step() adds this
    sensors.q_m[2] = sensors.theta_m[2] = results.robot.q_m[2];
    verdict = {};
    step();
  }
};

TEST(Monitor, AStopThatFollowsItsRampIsLeftAlone) {
  BrakingBench bench;
  for (int k = 0; k < 800; ++k) {
    bench.brake(0.0, 0.0);
    EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone) << k;
  }
}

TEST(Monitor, ABrakingRampBeginsWithTheAccelerationOfItsFirstSample) {
  Bench bench;
  bench.watched.state = SafetyState::kToArmed;
  double speed = 0.3, position = bench.results.robot.q_m[0];
  for (int k = 0; k < 800; ++k) {
    const double ddq = k == 0 ? -200.0 : 0.0;  // to 0.1 rad/s, which is kept
    bench.results.reference.dq_m[0] = bench.results.robot.dq_m[0] = speed;
    bench.results.reference.ddq_m[0] = ddq;
    bench.results.robot.q_m[0] = bench.results.reference.q_m[0] = position;
    bench.sensors.q_m[0] = bench.sensors.theta_m[0] = position;
    bench.step();
    EXPECT_EQ(bench.verdict.fault.code, FaultCode::kNone) << k;
    position += 1e-3 * (speed + 0.5e-3 * ddq);
    speed += 1e-3 * ddq;
  }
}

TEST(Monitor, AnAxisThatDoesNotBrakeAsCommandedGetsItsBrakes) {
  const auto first = [](double joint, double gantry, int samples) {
    BrakingBench bench;
    for (int k = 1; k <= samples; ++k) {
      bench.brake(joint, gantry);
      if (bench.verdict.fault.code != FaultCode::kNone) return std::pair(bench.verdict.fault, k);
    }
    return std::pair(bench.verdict.fault, -1);
  };
  const auto [fast, fast_at] = first(0.3, 0.0, 100);
  EXPECT_EQ(fast.code, FaultCode::kBrakingSpeed);
  EXPECT_EQ(fast.index, 2);
  EXPECT_EQ(fast_at, 5);
  const auto [slow, slow_at] = first(0.2, 0.0, 200);
  EXPECT_EQ(slow.code, FaultCode::kBrakingPosition);
  EXPECT_NEAR(slow_at, 134, 5);  // 0.025 rad, of which some are forgotten
  const auto [axis, axis_at] = first(0.0, 0.3, 100);
  EXPECT_EQ(axis.code, FaultCode::kBrakingSpeed);
  EXPECT_EQ(axis.index, 6 + 1);
  EXPECT_LE(axis_at, 10);
  for (const Fault& fault : {fast, slow, axis}) EXPECT_EQ(rule_of(fault.code).reaction, Stop::kSto);
}

TEST(Monitor, AStopThatGoesTooFarEndsEvenOnItsRamp) {
  Bench bench;
  bench.watched.state = SafetyState::kToArmed;
  // the reference runs on, and the joint follows it
  bench.results.reference.dq_m[0] = bench.results.robot.dq_m[0] = 0.5;
  const auto keep_moving = [&] {
    bench.results.robot.q_m[0] += 5e-4;
    bench.results.reference.q_m[0] = bench.sensors.q_m[0] = bench.sensors.theta_m[0] =
        bench.results.robot.q_m[0];
  };
  EXPECT_NEAR(bench.until_fault(FaultCode::kStopTooFar, keep_moving), 1441, 2);  // 90 % of 0.8 rad
  EXPECT_EQ(bench.verdict.fault.index, 0);
}

TEST(Monitor, AJumpIsDetectedBeforeTheSampleIsUsed) {
  Bench bench;
  EXPECT_FALSE(bench.monitor.has_jumped(bench.sensors, bench.state));
  bench.sensors.q_m[3] += 0.05;
  EXPECT_TRUE(bench.monitor.has_jumped(bench.sensors, bench.state));
}

TEST(Monitor, OfSeveralBrokenRulesTheHardestReactionCounts) {
  Bench bench;
  bench.sensors.w_S[0] = 200.0;
  bench.results.robot.dq_m[2] = 9.0;
  bench.run(5);
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kSpeedExceeded);  // SS1 before SS2
  bench.sensors.q_m[0] += 0.1;
  bench.step();
  EXPECT_EQ(bench.verdict.fault.code, FaultCode::kSensorJump);  // STO before both
  EXPECT_EQ(bench.verdict.warning.code, FaultCode::kSensorImplausible) << "the farthest beyond";
}

}  // namespace
}  // namespace hg::safety
