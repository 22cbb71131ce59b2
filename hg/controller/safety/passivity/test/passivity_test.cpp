#include "hg/controller/safety/passivity/passivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "hg/core/allocation_counter.h"

namespace hg::passivity {
namespace {

constexpr double kDt = 1e-3;

PassivityInput with_force(double amplitude, double frequency_Hz, double t) {
  PassivityInput input;
  input.f = Eigen::Vector3d(0.6, 0.0, 0.8) * amplitude *
            std::sin(2.0 * std::numbers::pi * frequency_Hz * t);
  input.mass = 2.0;
  return input;
}

// seconds until it is detected; infinity: not within 5 s
double time_to_trip(double amplitude, double frequency_Hz, double pull = 0.0) {
  const PassivityConfig config = {.reaction = Reaction::kAct};
  PassivityState state;
  for (int n = 0; n < 5000; ++n) {
    PassivityInput input = with_force(amplitude, frequency_Hz, kDt * n);
    input.f.x() += pull;
    if (observe_energy(config, kDt, input, state).oscillation >= 1.0) return kDt * n;
  }
  return kInfinity;
}

TEST(Passivity, DetectsShakingWithinHalfASecond) {
  for (const double frequency : {4.0, 6.0, 16.0, 20.0}) {
    EXPECT_LT(time_to_trip(6.0, frequency), 0.5) << frequency << " Hz";
  }
  for (const double frequency : {3.5, 6.0, 10.0, 20.0}) {
    EXPECT_LT(time_to_trip(40.0, frequency), 0.4) << frequency << " Hz";
  }
}

// 2 N rms along each of three axes are 5 N at the peak of their sum.
TEST(Passivity, LeavesAShakingHandAlone) {
  for (const double frequency : {8.0, 9.0, 10.0, 11.0, 12.0}) {
    for (const double amplitude : {1.5, 3.0, 5.0}) {
      EXPECT_EQ(time_to_trip(amplitude, frequency), kInfinity) << amplitude << " N, " << frequency;
    }
    EXPECT_LT(time_to_trip(12.0, frequency), 0.5) << "no hand does that";
  }
}

// The hand starts and stops hard: much force, of which nothing swings.
TEST(Passivity, LeavesHardStartsAndStopsAlone) {
  const PassivityConfig config = {.reaction = Reaction::kAct};
  PassivityState state;
  for (int n = 0; n < 4000; ++n) {
    const int phase = n % 1000;
    PassivityInput input;
    input.f.x() = phase < 150 ? 60.0 : (phase > 500 && phase < 650 ? -60.0 : 0.0);
    EXPECT_LT(observe_energy(config, kDt, input, state).oscillation, 1.0) << n;
  }
}

TEST(Passivity, LeavesSlowAndGentleForcesAlone) {
  EXPECT_EQ(time_to_trip(40.0, 0.4), kInfinity);  // a person moves
  EXPECT_EQ(time_to_trip(10.0, 0.8), kInfinity);
  EXPECT_EQ(time_to_trip(1.0, 8.0), kInfinity);        // less than 1 N rms: tremor
  EXPECT_EQ(time_to_trip(3.0, 8.0, 20.0), kInfinity);  // on top of a steady pull
}

TEST(Passivity, DoesNotCountImpacts) {
  const PassivityConfig config = {.reaction = Reaction::kAct};
  PassivityState state;
  for (int n = 0; n < 3000; ++n) {
    // every 0.4 s, and rings down
    const double since = kDt * (n % 400);
    PassivityInput input = with_force(30.0 * std::exp(-since / 0.05), 12.0, since);
    input.is_pushed_back = since < 0.05;
    EXPECT_LT(observe_energy(config, kDt, input, state).oscillation, 1.0);
  }
}

TEST(Passivity, CountsShakingAgainstASurfaceLater) {
  const PassivityConfig config = {.reaction = Reaction::kAct};
  PassivityState state;
  double at_s = kInfinity;
  for (int n = 0; n < 3000 && at_s == kInfinity; ++n) {
    PassivityInput input = with_force(20.0, 6.0, kDt * n);
    input.is_pushed_back = true;
    if (observe_energy(config, kDt, input, state).oscillation >= 1.0) at_s = kDt * n;
  }
  EXPECT_GT(at_s, 0.5);
  EXPECT_LT(at_s, 0.9);
}

TEST(Passivity, AddsDampingAtOnceAndRemovesItSlowly) {
  const PassivityConfig config = {.reaction = Reaction::kAct};
  PassivityState state;
  for (int n = 0; n < 1000; ++n) observe_energy(config, kDt, with_force(20.0, 6.0, kDt * n), state);
  EXPECT_NEAR(state.added.damping, 25.0, 0.1);
  EXPECT_NEAR(2.0 * state.added.inertia, 3.0, 0.01);
  double damped_s = 0.0;
  AddedImpedance before = state.added;
  for (int n = 0; n < 6000; ++n) {
    observe_energy(config, kDt, with_force(0.0, 6.0, 0.0), state);
    if (state.added.damping >= 24.0) damped_s += kDt;
    EXPECT_LE(before.damping - state.added.damping, 0.026);
    before = state.added;
  }
  EXPECT_GT(damped_s, 2.0);
  EXPECT_LT(damped_s, 3.5);
  EXPECT_EQ(state.added.damping, 0.0);
  EXPECT_EQ(state.added.inertia, 1.0);
}

TEST(Passivity, ObservesWithoutActing) {
  PassivityConfig config;
  config.reaction = Reaction::kObserve;
  PassivityState state;
  double index = 0.0;
  for (int n = 0; n < 1000; ++n) {
    index = std::max(
        index, observe_energy(config, kDt, with_force(20.0, 6.0, kDt * n), state).oscillation);
  }
  EXPECT_GE(index, 1.0);
  EXPECT_EQ(state.added.damping, 0.0);
  EXPECT_EQ(passivity_fault(config, {.tank = -1.0}, state).code, FaultCode::kNone);
}

TEST(Passivity, StopsShakingThatAddedDampingDoesNotEnd) {
  const PassivityConfig config = {.reaction = Reaction::kAct};
  PassivityState state;
  double stopped_s = kInfinity;
  for (int n = 0; n < 6000 && stopped_s == kInfinity; ++n) {
    const PassivityReport report =
        observe_energy(config, kDt, with_force(20.0, 6.0, kDt * n), state);
    if (passivity_fault(config, report, state).code == FaultCode::kOscillation) stopped_s = kDt * n;
  }
  EXPECT_GT(stopped_s, 3.0);
  EXPECT_LT(stopped_s, 3.8);
}

TEST(Passivity, StopsWhatGivesMoreEnergyThanItsTankHolds) {
  const PassivityConfig config = {.reaction = Reaction::kAct};
  PassivityState state;
  Fault fault;
  double given = 0.0;
  while (fault.code == FaultCode::kNone && given < 1000.0) {
    const PassivityReport report =
        observe_energy(config, kDt, {.power_measured = 0.0, .power_rendered = 50.0}, state);
    given += kDt * 50.0;
    fault = passivity_fault(config, report, state);
  }
  EXPECT_EQ(fault.code, FaultCode::kEnergy);
  EXPECT_NEAR(given, config.tank_start, 0.1);
}

// A body with added inertia and damping, pushed at random, moved a little late: what
// its port takes is never less than what it stores, less what the tank held.
TEST(Passivity, PortTakesWhatIsStoredLessTheTank) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const PassivityConfig config = {.reaction = Reaction::kAct};
    PassivityState state;
    const double mass = 0.3 + 0.2 * seed;
    double v = 0.0, v_late = 0.0, taken = 0.0, push = 0.0;
    for (int n = 0; n < 20000; ++n) {
      if (n % 40 == 0) push = 20.0 * normal(random) * (n % 8000 < 4000 ? 1.0 : 0.05);
      const AddedImpedance before = state.added;
      const double v_before = v;
      // Euler with the mean velocity, so that the balance of energy is exact; M' v / 2 belongs to
      // the port of the changing inertia
      const double M = mass * before.inertia;
      const double damping = 4.0 + before.damping;
      v = (v_before * (M / kDt - 0.5 * damping) + push) / (M / kDt + 0.5 * damping);
      const double mean = 0.5 * (v + v_before);
      v_late += 0.2 * (mean - v_late);
      PassivityInput input = {.f = {push, 0.0, 0.0},
                              .power_measured = push * v_late,
                              .power_rendered = push * mean,
                              .dissipation = damping * mean * mean,
                              .mass = mass,
                              .speed = std::abs(v)};
      taken += kDt * push * v_late;
      observe_energy(config, kDt, input, state);
      EXPECT_LE(0.5 * mass * (state.added.inertia - before.inertia),
                before.damping * kDt + state.added.damping * kDt + 1e-12);
      if (state.tank < 0.0) break;  // the device is stopped
      const double stored = 0.5 * mass * state.added.inertia * v * v;
      ASSERT_GE(taken, stored - config.tank_start - 1e-6) << "cycle " << n;
    }
  }
}

TEST(Passivity, AllocatesNothing) {
  const PassivityConfig config = {.reaction = Reaction::kAct};
  PassivityState state;
  const AllocationCounter allocations;
  for (int n = 0; n < 1000; ++n) observe_energy(config, kDt, with_force(20.0, 6.0, kDt * n), state);
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace hg::passivity
