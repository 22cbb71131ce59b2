#include "hg/studies/motion_analysis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace hg::studies {
namespace {

constexpr double kRate = 1000.0;  // Hz
constexpr double kPi = std::numbers::pi;

double at(std::size_t i) { return static_cast<double>(i) / kRate; }

// A handle that swings along `axis` with this acceleration, held without force.
std::vector<HandleSample> swinging(double frequency_Hz, double amplitude, double seconds,
                                   int axis = 0) {
  const double omega = 2.0 * kPi * frequency_Hz;
  std::vector<HandleSample> motion(static_cast<std::size_t>(seconds * kRate));
  for (std::size_t i = 0; i < motion.size(); ++i) {
    motion[i].a[axis] = amplitude * std::sin(omega * at(i));
    motion[i].v[axis] = -amplitude / omega * std::cos(omega * at(i));
    motion[i].p[axis] = -amplitude / (omega * omega) * std::sin(omega * at(i));
  }
  return motion;
}

// The person exerts what moves a free body so, and `extra` upwards.
void pull(const FreeTwin& twin, double extra, std::vector<HandleSample>& motion) {
  for (HandleSample& now : motion) {
    now.f = twin.mass * now.a + twin.damping * now.v + extra * Eigen::Vector3d::UnitZ();
  }
}

TEST(SpectralCentroid, OfASineIsItsFrequencyWhateverItsAxis) {
  constexpr double kBins = 0.3;  // Hz: what the window spreads around a sine is symmetric
  for (const double frequency : {30.0, 97.0, 250.0}) {
    for (const int axis : {0, 2}) {
      EXPECT_NEAR(spectral_centroid(swinging(frequency, 1.0, 4.0, axis), kRate), frequency, kBins);
    }
  }
}

TEST(SpectralCentroid, WeighsWithMagnitudeAndNotWithPower) {
  std::vector<HandleSample> motion = swinging(50.0, 3.0, 4.0);
  const std::vector<HandleSample> other = swinging(150.0, 1.0, 4.0, 1);
  for (std::size_t i = 0; i < motion.size(); ++i) motion[i].a += other[i].a;
  EXPECT_NEAR(spectral_centroid(motion, kRate), 75.0, 1.0);  // with power: 60 Hz
}

TEST(SpectralCentroid, IgnoresWhatIsBelow20Hz) {
  std::vector<HandleSample> motion = swinging(100.0, 0.1, 4.0);
  const std::vector<HandleSample> walk = swinging(2.0, 5.0, 4.0);
  for (std::size_t i = 0; i < motion.size(); ++i) motion[i].a += walk[i].a;
  EXPECT_NEAR(spectral_centroid(motion, kRate), 100.0, 1.0);
}

TEST(SpectralCentroid, NeedsOneWindow) {
  EXPECT_EQ(spectral_centroid(swinging(100.0, 1.0, 0.499), kRate), 0.0);
  EXPECT_GT(spectral_centroid(swinging(100.0, 1.0, 0.5), kRate), 0.0);
  EXPECT_EQ(spectral_centroid(std::vector<HandleSample>(1000), kRate), 0.0);
}

TEST(Feel, VibrationIsTheRmsAboveItsCutoff) {
  const double rms = 2.0 / std::numbers::sqrt2;
  const Feel fast = feel(swinging(100.0, 2.0, 5.0), {}, kRate, 1.0);
  EXPECT_NEAR(fast.vibration_5, rms, 0.01 * rms);
  EXPECT_NEAR(fast.vibration_20, rms, 0.01 * rms);
  const Feel between = feel(swinging(10.0, 2.0, 5.0), {}, kRate, 1.0);
  EXPECT_NEAR(between.vibration_5, rms, 0.04 * rms);
  EXPECT_LT(between.vibration_20, 0.26 * rms);  // an octave below, 12 dB
  EXPECT_LT(feel(swinging(0.5, 2.0, 5.0), {}, kRate, 1.0).vibration_5, 0.02 * rms);
}

TEST(Feel, ABodyThatIsTheTwinNeedsItsOwnShareAndNothingElse) {
  constexpr FreeTwin kTwin = {.mass = 3.0, .damping = 8.0};
  std::vector<HandleSample> motion = swinging(0.5, 1.0, 9.0);
  pull(kTwin, 0.0, motion);
  const Feel alone = feel(motion, kTwin, kRate, 1.0);
  // m a and b v in quadrature: mean of a rectified sine
  const double mean = 2.0 / kPi * std::hypot(3.0, 8.0 / kPi);
  EXPECT_NEAR(alone.force, mean, 1e-3 * mean);
  EXPECT_NEAR(alone.own_share, mean, 1e-3 * mean);
  EXPECT_NEAR(alone.extra, 0.0, 1e-9);

  pull(kTwin, 0.25, motion);
  const Feel more = feel(motion, kTwin, kRate, 1.0);
  EXPECT_NEAR(more.extra, 0.25, 1e-3);
  EXPECT_NEAR(more.own_share, mean, 1e-3 * mean);
  EXPECT_GT(more.force, mean);
}

TEST(Feel, ForceIsJudgedBelow20Hz) {
  constexpr double kMean = 2.0 / kPi * 6.0;  // N: of 6 kg at 1 m/s^2
  EXPECT_NEAR(feel(swinging(5.0, 1.0, 5.0), {6.0, 0.0}, kRate, 1.0).extra, kMean, 0.03 * kMean);
  EXPECT_LT(feel(swinging(80.0, 1.0, 5.0), {6.0, 0.0}, kRate, 1.0).extra, 0.08 * kMean);
}

TEST(Feel, TheBeginningDoesNotCount) {
  std::vector<HandleSample> motion(3000);
  for (std::size_t i = 0; i < 1000; ++i) motion[i].f.x() = 50.0;
  EXPECT_EQ(feel(motion, {}, kRate, 1.0).force, 0.0);
  EXPECT_NEAR(feel(motion, {}, kRate, 0.5).force, 10.0, 1e-9);
  EXPECT_EQ(feel(motion, {}, kRate, 3.0).force, 0.0);  // nothing is left
}

TEST(Phasor, IsAmplitudeAndPhaseOfOneFrequency) {
  std::vector<double> x(2000);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = 5.0 - 3.0 * std::cos(2.0 * kPi * 8.0 * at(i) + 0.4) +
           2.0 * std::cos(2.0 * kPi * 20.0 * at(i));
  }
  EXPECT_NEAR(std::abs(phasor(x, 8.0, kRate) - std::polar(3.0, 0.4 - kPi)), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(phasor(x, 20.0, kRate) - std::polar(2.0, 0.0)), 0.0, 1e-9);
  EXPECT_NEAR(std::abs(phasor(x, 12.0, kRate)), 0.0, 1e-9);
}

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

TEST(Verdict, HasALetterAndAName) {
  EXPECT_EQ(symbol(Verdict::kStable), '.');
  EXPECT_EQ(symbol(Verdict::kSlow), 'r');
  EXPECT_EQ(symbol(Verdict::kSustained), 'U');
  EXPECT_EQ(symbol(Verdict::kDiverges), 'X');
  EXPECT_EQ(symbol(Verdict::kHunts), 'h');
  EXPECT_TRUE(is_stable(Verdict::kSlow));
  EXPECT_FALSE(is_stable(Verdict::kHunts));
  EXPECT_FALSE(is_stable(Verdict::kSustained));
}

}  // namespace
}  // namespace hg::studies
