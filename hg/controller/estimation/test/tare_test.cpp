#include "hg/controller/estimation/tare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace hg::estimation {
namespace {

constexpr double kDt = 1e-3;
const Vector6 kOffset = (Vector6() << 3, -4, 5, 0.1, -0.2, 0.3).finished();

// One tare; what acts on it besides offset and noise of the sensor, as functions of time.
struct Trial {
  std::function<Vector6(double)> touch = [](double) -> Vector6 { return Vector6::Zero(); };
  std::function<bool(double)> held = [](double) { return false; };
  std::function<double(double)> motion = [](double) { return 0.0; };  ///< of joint m3
  double gantry_motion = 0.0;                                         ///< towards the end
  double noise = 1.0;                                                 ///< times the sensor's

  TareState run(unsigned seed, TareState tare = {}) const {
    const TareConfig config;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    begin(tare);
    for (int k = 0; k < 1000 && tare.status == TareStatus::kUnderWay; ++k) {
      const double t = k * kDt;
      Vector6 w_S = kOffset + touch(t);
      for (int i = 0; i < 6; ++i) {
        w_S[i] += noise * normal(random) * (i < 3 ? config.noise_force : config.noise_torque);
      }
      VectorM q_m = VectorM::Constant(6, 0.3);
      q_m[2] += motion(t);
      const VectorP q_p = VectorP::Constant(2, k > 400 ? gantry_motion : 0.0);
      advance(config, kDt, w_S, held(t), q_m, q_p, tare);
    }
    return tare;
  }
};

// a wrench along x, times a function of time
std::function<Vector6(double)> force(const std::function<double(double)>& f) {
  return [f](double t) -> Vector6 { return Vector6::Unit(0) * f(t); };
}

class TareSeeds : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, TareSeeds, testing::Range(0u, 20u));

TEST_P(TareSeeds, FindsTheOffsetOfAFreeHandle) {
  const TareState tare = Trial{}.run(GetParam());
  ASSERT_EQ(tare.status, TareStatus::kDone);
  EXPECT_TRUE(tare.is_valid);
  EXPECT_EQ(tare.count, 500);
  // four standard deviations of the mean of 500 samples
  EXPECT_LT((tare.offset - kOffset).head<3>().cwiseAbs().maxCoeff(), 4.5 * 0.08 / std::sqrt(500));
  EXPECT_LT((tare.offset - kOffset).tail<3>().cwiseAbs().maxCoeff(), 4.5 * 2.6e-3 / std::sqrt(500));
}

TEST_P(TareSeeds, RefusesAndKeepsTheOldOne) {
  struct Case {
    const char* what;
    Trial trial;
    TareStatus status;
  };
  const auto late = [](double t) { return t > 0.4; };
  const std::vector<Case> cases = {
      {"held", {.held = [](double) { return true; }}, TareStatus::kRefusedHeld},
      {"grasped on the way", {.held = late}, TareStatus::kRefusedHeld},
      {"a joint creeps", {.motion = [](double t) { return 4e-3 * t; }}, TareStatus::kRefusedMoving},
      {"the gantry moves", {.gantry_motion = 2e-3}, TareStatus::kRefusedMoving},
      {"a touch",
       {.touch = force([&](double t) { return late(t) ? 0.5 : 0.0; })},
       TareStatus::kRefusedUnsteady},
      {"a hand goes",
       {.touch = force([](double t) { return 0.3 - 0.6 * t; })},
       TareStatus::kRefusedUnsteady},
      {"shaking",
       {.touch = force([](double t) { return 0.5 * std::sin(60 * t); })},
       TareStatus::kRefusedUnsteady},
      {"a twist",
       {.touch = [&](double t) -> Vector6 { return Vector6::Unit(5) * (late(t) ? 0.02 : 0.0); }},
       TareStatus::kRefusedUnsteady},
      {"a broken sensor", {.noise = 4.0}, TareStatus::kRefusedUnsteady}};
  for (const Case& c : cases) {
    const TareState old = Trial{}.run(1000 + GetParam());
    ASSERT_TRUE(old.is_valid);
    const TareState tare = c.trial.run(GetParam(), old);
    EXPECT_EQ(tare.status, c.status) << c.what;
    EXPECT_TRUE(tare.is_valid) << c.what;
    EXPECT_EQ(tare.offset, old.offset) << c.what;

    const TareState first = c.trial.run(GetParam());
    EXPECT_FALSE(first.is_valid) << c.what;
    EXPECT_EQ(first.offset, Vector6::Zero()) << c.what;
  }
}

TEST(Tare, ANewOneReplacesTheOld) {
  const TareState again = Trial{}.run(2, Trial{}.run(1));
  EXPECT_EQ(again.status, TareStatus::kDone);
  EXPECT_LT((again.offset - kOffset).norm(), 0.05);
}

TEST(Tare, DoesNothingUnlessRequested) {
  TareState tare;
  for (int k = 0; k < 2000; ++k) {
    advance({}, kDt, kOffset, false, VectorM::Zero(6), VectorP::Zero(2), tare);
  }
  EXPECT_EQ(tare.status, TareStatus::kNone);
  EXPECT_EQ(tare.offset, Vector6::Zero());
}

}  // namespace
}  // namespace hg::estimation
