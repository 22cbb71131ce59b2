#include "hg/controller/safety/shaking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "hg/core/allocation_counter.h"
#include "hg/core/interval.h"

namespace hg::safety {
namespace {

constexpr double kDt = 1e-3;

struct Cycle {
  Vector6 w_S = Vector6::Zero(), w_H = Vector6::Zero();
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero(), contact_force = Eigen::Vector3d::Zero();
  double oscillation = 0.0;

  ShakingInput input() const { return {w_S, w_H, v_H, contact_force, oscillation}; }
};

struct Found {
  double at_s = kInfinity;
  Shaking what = Shaking::kNone;
};

Found look(double seconds, const std::function<void(double, Cycle&)>& make) {
  const ShakingWatch watch(kDt, 6.0);
  ShakingState state;
  Found found;
  for (int n = 0; n < static_cast<int>(seconds / kDt); ++n) {
    Cycle cycle;
    make(kDt * n, cycle);
    const ShakingReport report = watch.step(cycle.input(), state);
    if (report.index >= 1.0 && found.what == Shaking::kNone) found = {kDt * n, report.what};
  }
  return found;
}

double sine(double frequency_Hz, double t) {
  return std::sin(2.0 * std::numbers::pi * frequency_Hz * t);
}

Found torque_of(double amplitude, double frequency_Hz, double pull = 0.0) {
  return look(5.0, [&](double t, Cycle& cycle) {
    cycle.w_H[4] = pull + amplitude * sine(frequency_Hz, t);
  });
}

Found sensed(int component, double amplitude, double frequency_Hz) {
  return look(5.0, [&](double t, Cycle& cycle) {
    cycle.w_S[component] = amplitude * sine(frequency_Hz, t);
  });
}

TEST(Shaking, FindsTorquesTo30Hz) {
  for (const double frequency : {3.5, 8.0, 20.0}) {
    const Found found = torque_of(0.5, frequency);
    EXPECT_EQ(found.what, Shaking::kTorque) << frequency;
    EXPECT_LT(found.at_s, 0.7) << frequency;
  }
  EXPECT_EQ(torque_of(0.1, 8.0).what, Shaking::kNone);       // less than 0.1 Nm rms
  EXPECT_EQ(torque_of(0.5, 8.0, 2.0).what, Shaking::kNone);  // on top of a steady turn
  EXPECT_EQ(torque_of(5.0, 0.8).what, Shaking::kNone);       // a person turns it to and fro
}

TEST(Shaking, FindsWhatTheSensorFeelsAbove30Hz) {
  for (const double frequency : {40.0, 74.0, 150.0}) {
    EXPECT_EQ(sensed(1, 3.0, frequency).what, Shaking::kFastForce) << frequency;
    EXPECT_EQ(sensed(5, 0.3, frequency).what, Shaking::kFastTorque) << frequency;
    EXPECT_LT(sensed(5, 0.3, frequency).at_s, 0.6) << frequency;
    EXPECT_EQ(sensed(1, 1.0, frequency).what, Shaking::kNone) << frequency;
  }
  EXPECT_EQ(sensed(1, 10.0, 8.0).what, Shaking::kNone);  // not above 30 Hz
  const Found impact = look(5.0, [](double t, Cycle& cycle) {
    cycle.w_S[1] = 30.0 * std::exp(-t / 0.05) * sine(74.0, t);
  });
  EXPECT_EQ(impact.what, Shaking::kNone);
}

// A body against a wall that pushes it out again: contacts of 0.1 s every 0.5 s.
Found bounces(double speed, double kept, double power, int count) {
  return look(6.0, [&](double t, Cycle& cycle) {
    const int n = static_cast<int>(t / 0.5);
    if (n >= count) return;
    const double v = speed * std::pow(kept, n);
    const double phase = t - 0.5 * n;
    cycle.v_H.x() = phase < 0.05 || phase > 0.3 ? v : -v;
    if (phase < 0.1) cycle.contact_force.x() = -50.0;
    cycle.w_H.x() = power / cycle.v_H.x();
  });
}

TEST(Shaking, FindsABodyThatBouncesAndDrivesTheHand) {
  const Found found = bounces(0.4, 1.0, -4.0, 12);
  EXPECT_EQ(found.what, Shaking::kBouncing);
  EXPECT_LT(found.at_s, 1.6);
  EXPECT_EQ(bounces(0.4, 1.0, 4.0, 12).what, Shaking::kNone);    // a person taps
  EXPECT_EQ(bounces(0.4, 1.0, -0.1, 5).what, Shaking::kNone);    // no more than what it had
  EXPECT_EQ(bounces(0.4, 1.0, -4.0, 2).what, Shaking::kNone);    // there and back
  EXPECT_EQ(bounces(0.4, 0.6, -4.0, 12).what, Shaking::kNone);   // decays
  EXPECT_EQ(bounces(0.04, 1.0, -4.0, 12).what, Shaking::kNone);  // creeps
}

TEST(Shaking, PassesOnWhatPassivityFinds) {
  const Found found = look(0.1, [](double, Cycle& cycle) { cycle.oscillation = 1.5; });
  EXPECT_EQ(found.what, Shaking::kForce);
}

TEST(Shaking, AllocatesNothing) {
  const ShakingWatch watch(kDt, 6.0);
  ShakingState state;
  const Cycle cycle;
  const AllocationCounter allocations;
  for (int n = 0; n < 100; ++n) (void)watch.step(cycle.input(), state);
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace hg::safety
