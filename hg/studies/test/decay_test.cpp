#include "hg/studies/decay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace hg::studies {
namespace {

constexpr double kRate = 1000.0;  // Hz
constexpr double kPi = std::numbers::pi;

double at(std::size_t i) { return static_cast<double>(i) / kRate; }

// Speed of a ring-down or its opposite: falls to `share` every second.
std::vector<double> ringing(double first, double share, double seconds = 4.0) {
  std::vector<double> speed(static_cast<std::size_t>(seconds * kRate));
  for (std::size_t i = 0; i < speed.size(); ++i) {
    speed[i] = first * std::pow(share, at(i)) * std::abs(std::sin(2.0 * kPi * 5.0 * at(i)));
  }
  return speed;
}

TEST(JudgeDecay, TellsTheFourEndsOfAKickApart) {
  EXPECT_EQ(judge_decay(ringing(0.05, 0.01), {}, kRate), Verdict::kStable);
  EXPECT_EQ(judge_decay(ringing(0.05, 0.6), {}, kRate), Verdict::kSlow);
  EXPECT_EQ(judge_decay(ringing(0.05, 1.0), {}, kRate), Verdict::kSustained);
  EXPECT_EQ(judge_decay(ringing(0.05, 3.0), {}, kRate), Verdict::kDiverges);
}

TEST(JudgeDecay, WhatIsCalmIsStableAlsoWhenItGrowsOrGoesOn) {
  EXPECT_EQ(judge_decay(ringing(0.0059, 1.0), {}, kRate), Verdict::kStable);
  EXPECT_EQ(judge_decay(ringing(0.0062, 1.0), {}, kRate), Verdict::kSustained);
  EXPECT_EQ(judge_decay(ringing(0.00005, 3.0), {}, kRate), Verdict::kStable);
}

TEST(JudgeDecay, ASlowSwingThatDiesOutIsNotSustained) {
  std::vector<double> speed(4000);
  for (std::size_t i = 0; i < speed.size(); ++i) {  // 0.35 Hz: seconds without a peak
    speed[i] = 0.04 * std::exp(-0.45 * at(i)) * std::abs(std::cos(2.0 * kPi * 0.35 * at(i)));
  }
  EXPECT_EQ(judge_decay(speed, {}, kRate), Verdict::kSlow);
}

TEST(JudgeDecay, TheKickItselfDoesNotCount) {
  std::vector<double> speed(4000, 0.02);
  std::fill(speed.begin(), speed.begin() + 1000, 1.0);
  EXPECT_EQ(judge_decay(speed, {}, kRate), Verdict::kSustained);
}

TEST(Verdict, OfAHandleThatComesToRestIsStable) {
  EXPECT_TRUE(is_stable(Verdict::kSlow));
  EXPECT_FALSE(is_stable(Verdict::kHunts));
  EXPECT_FALSE(is_stable(Verdict::kSustained));
}

}  // namespace
}  // namespace hg::studies
