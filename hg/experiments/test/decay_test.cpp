#include "hg/experiments/decay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace hg::experiments {
namespace {

constexpr double kRate = 1000.0;  // Hz
constexpr double kPi = std::numbers::pi;

double at(std::size_t i) { return static_cast<double>(i) / kRate; }

// Speed of a ring-down or its opposite: falls to `share` every second.
std::vector<double> ringing(double first, double share, double seconds = 4.0) {
  std::vector<double> speed(std::lround(seconds * kRate));
  for (std::size_t i = 0; i < speed.size(); ++i) {
    speed[i] = first * std::pow(share, at(i)) * std::abs(std::sin(2.0 * kPi * 5.0 * at(i)));
  }
  return speed;
}

TEST(JudgeDecay, DistinguishesTheFourEndsOfAKick) {
  EXPECT_EQ(judge_decay(ringing(0.05, 0.01), {}, kRate), DecayClass::kStable);
  EXPECT_EQ(judge_decay(ringing(0.05, 0.6), {}, kRate), DecayClass::kSlow);
  EXPECT_EQ(judge_decay(ringing(0.05, 1.0), {}, kRate), DecayClass::kSustained);
  EXPECT_EQ(judge_decay(ringing(0.05, 3.0), {}, kRate), DecayClass::kDiverges);
}

TEST(JudgeDecay, WhatIsCalmIsStableAlsoWhenItGrowsOrGoesOn) {
  EXPECT_EQ(judge_decay(ringing(0.0059, 1.0), {}, kRate), DecayClass::kStable);
  EXPECT_EQ(judge_decay(ringing(0.0062, 1.0), {}, kRate), DecayClass::kSustained);
  EXPECT_EQ(judge_decay(ringing(0.00005, 3.0), {}, kRate), DecayClass::kStable);
}

TEST(JudgeDecay, ASlowSwingThatDiesOutIsNotSustained) {
  std::vector<double> speed(4000);
  for (std::size_t i = 0; i < speed.size(); ++i) {  // 0.35 Hz: seconds without a peak
    speed[i] = 0.04 * std::exp(-0.45 * at(i)) * std::abs(std::cos(2.0 * kPi * 0.35 * at(i)));
  }
  EXPECT_EQ(judge_decay(speed, {}, kRate), DecayClass::kSlow);
}

TEST(JudgeDecay, TheKickItselfDoesNotCount) {
  std::vector<double> speed(4000, 0.02);
  std::fill(speed.begin(), speed.begin() + 1000, 1.0);
  EXPECT_EQ(judge_decay(speed, {}, kRate), DecayClass::kSustained);
}

TEST(Verdict, OfAHandleThatComesToRestIsStable) {
  EXPECT_TRUE(is_stable(DecayClass::kSlow));
  EXPECT_FALSE(is_stable(DecayClass::kHunts));
  EXPECT_FALSE(is_stable(DecayClass::kSustained));
}

}  // namespace
}  // namespace hg::experiments
