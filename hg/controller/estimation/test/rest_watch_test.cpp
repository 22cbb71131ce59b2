#include "hg/controller/estimation/rest_watch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "hg/controller/estimation/low_pass.h"

namespace hg::estimation {
namespace {

constexpr double kDt = 1e-3;

// A handle whose sensor shows a drift along x, what touches it, and noise, as functions of time.
struct Trial {
  std::function<double(double)> force = [](double) { return 0.0; };
  std::function<double(double)> tremor = [](double) { return 0.0; };  ///< N, rms
  double noise = 0.08;                                                ///< N, rms of a sample
  double low_pass_Hz = 0.0;                                           ///< 0 = none
  int reads = 1;                                                      ///< of each sample
  RestInput input = {.payload_mass = 1.0, .is_free = true, .is_slow = true};
  std::function<void(double, const RestState&)> look = [](double, const RestState&) {};

  RestState run(unsigned seed, double begin, double end, RestState rest = {}) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::array<double, 8> omega{}, phase{};
    for (int i = 0; i < 8; ++i) {
      omega[i] = 2.0 * std::numbers::pi * (8.0 + 0.5 * (i + uniform(random)));
      phase[i] = 2.0 * std::numbers::pi * uniform(random);
    }
    RestInput now = input;
    Vector6 seen = Vector6::Zero();
    int count = 0;
    for (double t = begin; t < end; t += kDt, ++count) {
      if (count % reads == 0) {
        seen = Vector6::Unit(0) * force(t);
        for (int i = 0; i < 3; ++i) {
          double sum = 0.0;
          for (int k = 0; k < 8; ++k) sum += std::sin(omega[k] * t + phase[k] + 2.0 * i * k);
          seen[i] += 0.5 * tremor(t) * sum + noise * normal(random);
          seen[i + 3] += noise / 30.0 * normal(random);
        }
      }
      if (count == 0) now.w_S = seen;
      low_pass(low_pass_pole(low_pass_Hz, kDt), seen, now.w_S);
      see_noise(kDt, seen, rest);
      advance(kDt, now, rest);
      look(t, rest);
    }
    return rest;
  }
};

class RestWatchSeeds : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, RestWatchSeeds, testing::Range(0u, 20u));

TEST_P(RestWatchSeeds, ASteadyWrenchOfAFreeHandleBecomesTheZero) {
  Trial trial = {.force = [](double t) { return t < 1.0 ? 20.0 : 2.0; }};
  const RestState rest = trial.run(GetParam(), 0.0, 6.0);
  EXPECT_TRUE(rest.is_untouched);
  EXPECT_NEAR(rest.zero[0], 2.0, 0.1);
  EXPECT_LT(rest.zero.tail<5>().norm(), 0.06);
  EXPECT_GT(braking_rate(rest), 20.0);
}

TEST_P(RestWatchSeeds, TenNewtonInTenMinutesAreFollowed) {
  Trial trial = {.force = [](double t) { return t / 60.0; }};
  trial.look = [&](double t, const RestState& rest) {
    if (t > 6.0) {
      ASSERT_NEAR(rest.zero[0], trial.force(t), 0.1) << t;
    }
  };
  trial.run(GetParam(), 0.0, 60.0);
}

// A hand pushes with 2 N for a minute.
TEST_P(RestWatchSeeds, AHandThatPushesSteadilyIsNotTakenForDrift) {
  Trial trial = {.force = [](double) { return 2.0; }, .tremor = [](double) { return 0.035; }};
  trial.look = [](double t, const RestState& rest) {
    ASSERT_EQ(braking_rate(rest), 0.0) << t;
    ASSERT_EQ(rest.zero, Vector6::Zero().eval()) << t;
  };
  trial.run(GetParam(), 0.0, 60.0);
}

// That of a relaxed person trembles least: at worst the twin is braked for a moment.
TEST_P(RestWatchSeeds, ARelaxedHandIsNotTakenForDrift) {
  Trial trial = {.force = [](double) { return 2.0; }, .tremor = [](double) { return 0.025; }};
  EXPECT_EQ(trial.run(GetParam(), 0.0, 60.0).zero, Vector6::Zero().eval());
}

// Even one without any tremor, once the zero is known.
TEST_P(RestWatchSeeds, ATouchEndsTheBrakingAtOnceAndNothingIsTakenFromIt) {
  for (const double push : {0.8, 1.0, -5.0}) {
    Trial trial = {.force = [=](double t) { return t < 8.0 ? 0.5 : 0.5 + push; }};
    trial.look = [](double t, const RestState& rest) {
      if (t > 8.015) {
        ASSERT_EQ(braking_rate(rest), 0.0) << t;
      }
    };
    const RestState rest = trial.run(GetParam(), 0.0, 14.0);
    EXPECT_NEAR(rest.zero[0], 0.5, 0.06);
  }
}

TEST_P(RestWatchSeeds, ASlowlyGrowingPushIsFelt) {
  Trial trial = {.force = [](double t) { return t < 6.0 ? 0.0 : 0.2 * (t - 6.0); }};
  const RestState rest = trial.run(GetParam(), 0.0, 16.0);
  EXPECT_LT(rest.zero[0], 0.4);
  EXPECT_EQ(braking_rate(rest), 0.0);
}

TEST_P(RestWatchSeeds, ATareSeesAHandThatTrembles) {
  Trial trial = {.force = [](double) { return 5.0; }};
  EXPECT_FALSE(trembles(kDt, 0.08, trial.run(GetParam(), 0.0, 0.5)));
  trial.tremor = [](double) { return 0.035; };
  EXPECT_TRUE(trembles(kDt, 0.08, trial.run(GetParam(), 0.0, 0.5)));
}

// A machine that pushes slowly does not tremble, and stands nearly still where it turns round.
TEST(RestWatch, ASlowSwingWithoutTremorIsAPush) {
  for (const double frequency_Hz : {0.1, 0.2}) {
    Trial swung = {.force = [=](double t) {
      return 10.0 * std::sin(2.0 * std::numbers::pi * frequency_Hz * t);
    }};
    swung.input.acceleration = 1.2;
    swung.look = [](double t, const RestState& now) { ASSERT_EQ(braking_rate(now), 0.0) << t; };
    swung.run(1, 0.0, 30.0);
  }
}

// A tare is not refused for ever where device.yaml promises a better sensor.
TEST_P(RestWatchSeeds, NoiseBeyondTheStatedOneIsNoTremor) {
  for (const double noise : {0.12, 0.16, 0.2}) {
    for (const double low_pass_Hz : {0.0, 160.0, 50.0}) {
      for (const int reads : {1, 2}) {
        Trial noisy = {.noise = noise, .low_pass_Hz = low_pass_Hz, .reads = reads};
        int trembling = 0, all = 0;
        noisy.look = [&](double t, const RestState& now) {
          if (t < 0.6) return;
          ++all;
          trembling += trembles(kDt, 0.08, now);
        };
        noisy.run(GetParam(), 0.0, 6.0);
        EXPECT_LT(trembling, 0.2 * all) << noise << " N, " << low_pass_Hz << " Hz, " << reads;
      }
    }
  }
}

// A steady push moves a light twin off with a heavy payload's acceleration: no rest for 1.6 s.
TEST(RestWatch, APushIsSeenAlsoWhereThePayloadIsHeavy) {
  Trial pushed = {.force = [](double t) { return t < 3.0 ? 0.0 : 10.0; }, .noise = 0.0};
  pushed.input.payload_mass = 3.0;
  pushed.input.acceleration = 1.7;
  RestState rest = pushed.run(1, 0.0, 2.9);
  rest.braked_s = 0.0;  // a twin that is pushed is not at rest before
  pushed.input.is_free = false;
  rest = pushed.run(1, 2.9, 3.05, rest);
  EXPECT_FALSE(rest.is_untouched);
  pushed.input.is_free = true;
  pushed.look = [](double t, const RestState& now) { ASSERT_EQ(braking_rate(now), 0.0) << t; };
  pushed.run(1, 3.05, 4.5, rest);
}

// A tool that is let go, with a wrong payload: its drives shake it a little.
TEST_P(RestWatchSeeds, AWeightThatIsLetGoIsBrakedBeforeItFliesOff) {
  Trial trial = {.force = [](double t) { return t < 3.0 ? 3.0 * std::sin(4.0 * t) : 5.0; },
                 .tremor = [](double t) { return t < 3.0 ? 0.06 : 0.012; }};
  const RestState held = trial.run(GetParam(), 0.0, 3.0);
  EXPECT_FALSE(held.is_untouched);
  trial.input.v_H = {0.3, 0.0, 0.0};
  const RestState rest = trial.run(GetParam(), 3.0, 4.0, held);
  EXPECT_GT(braking_rate(rest), 10.0);
}

// A person who carries a tool: trembling with a steady force, or with a spring's.
TEST_P(RestWatchSeeds, AHandThatMovesAToolIsNoWeight) {
  Trial steady = {.force = [](double) { return 3.0; }, .tremor = [](double) { return 0.04; }};
  Trial spring = {.force = [](double t) { return 2.0 + 10.0 * std::fmod(t, 2.0); }};
  for (Trial* trial : {&steady, &spring}) {
    trial->input.v_H = {0.1, 0.0, 0.0};
    trial->look = [](double t, const RestState& now) { ASSERT_EQ(braking_rate(now), 0.0) << t; };
    trial->run(GetParam(), 0.0, 10.0);
  }
}

// Turning would explain each of these forces, but not that they are the same one.
TEST_P(RestWatchSeeds, AHandThatTurnsAToolIsNoWeight) {
  Trial turning = {.force = [](double t) { return 6.0 * std::sin(2.0 * t); },
                   .tremor = [](double) { return 0.012; }};
  turning.input.v_H = {0.1, 0.0, 0.0};
  turning.input.up_S = Eigen::Vector3d::UnitX();
  RestState rest = turning.run(GetParam(), 0.0, 0.2);
  turning.input.up_S = Eigen::Vector3d::UnitZ();
  turning.look = [](double t, const RestState& now) { ASSERT_EQ(braking_rate(now), 0.0) << t; };
  turning.run(GetParam(), 0.2, 6.0, rest);
}

TEST(RestWatch, LetsTheTwinBeWhereSomethingElseMovesOrHoldsIt) {
  Trial held = {.force = [](double) { return 2.0; }};
  held.input.is_free = false;
  EXPECT_EQ(held.run(1, 0.0, 10.0).zero, Vector6::Zero().eval());
  Trial coasting = {.force = [](double) { return 2.0; }};
  coasting.input.is_slow = false;
  EXPECT_EQ(coasting.run(1, 0.0, 10.0).zero, Vector6::Zero().eval());
}

// A machine that leans on the handle, or a weight hung on it, is no drift of a sensor.
TEST(RestWatch, AFirstZeroIsNoLargeForce) {
  Trial pushed = {.force = [](double) { return 20.0; }};
  const RestState rest = pushed.run(1, 0.0, 10.0);
  EXPECT_EQ(rest.zero, Vector6::Zero().eval());
  EXPECT_EQ(braking_rate(rest), 0.0);
}

TEST(RestWatch, AKnownZeroIsGivenUpWhereTheToolHasTurned) {
  Trial trial;
  const RestState known = trial.run(1, 0.0, 5.0);
  trial.force = [](double) { return 5.0; };
  EXPECT_NEAR(trial.run(2, 5.0, 12.0, known).zero[0], 0.0, 0.1);
  trial.input.up_S = Eigen::Vector3d::UnitX();
  EXPECT_NEAR(trial.run(2, 5.0, 12.0, known).zero[0], 5.0, 0.1);
}

TEST(RestWatch, ASensorWhoseNoiseHidesATremorIsNeverUntouched) {
  Trial trial = {.force = [](double) { return 2.0; },
                 .noise = 0.3,
                 .input = {.noise = 0.3, .is_free = true, .is_slow = true}};
  trial.look = [](double, const RestState& rest) { ASSERT_FALSE(rest.is_untouched); };
  trial.run(1, 0.0, 20.0);
}

}  // namespace
}  // namespace hg::estimation
