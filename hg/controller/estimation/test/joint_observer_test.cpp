#include "hg/controller/estimation/joint_observer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace hg::estimation {
namespace {

constexpr double kDt = 1e-3;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

TEST(LowPass, AnswersAStepWithTheExponentialOfItsCorner) {
  for (const double f : {20.0, 50.0, 200.0}) {
    const double pole = low_pass_pole(f, kDt);
    double y = 0.0;
    for (int k = 1; k <= 50; ++k) {
      low_pass(pole, 1.0, y);
      ASSERT_NEAR(y, 1.0 - std::exp(-kTwoPi * f * k * kDt), 1e-12) << f << " Hz, sample " << k;
    }
  }
}

TEST(LowPass, HasTheFrequencyResponseOfItsPole) {
  const double pole = low_pass_pole(50.0, kDt);
  for (const double f : {5.0, 50.0, 300.0}) {
    // amplitude after the transient, by correlation over whole periods
    std::complex<double> sum = 0.0;
    double y = 0.0;
    for (int k = 0; k < 2000; ++k) {
      low_pass(pole, std::cos(kTwoPi * f * k * kDt), y);
      if (k >= 1000) sum += 2.0 / 1000 * y * std::polar(1.0, -kTwoPi * f * k * kDt);
    }
    const std::complex<double> expected =
        (1.0 - pole) / (1.0 - pole * std::polar(1.0, -kTwoPi * f * kDt));
    EXPECT_LT(std::abs(sum - expected), 1e-9) << f << " Hz";
  }
  // the corner is at its nominal frequency: -3.0 dB
  const double at_corner = std::abs((1.0 - pole) / (1.0 - pole * std::polar(1.0, -kTwoPi * 0.05)));
  EXPECT_NEAR(20.0 * std::log10(at_corner), -3.0, 0.1);
}

TEST(LowPass, DelaysARampByTheStatedTime) {
  for (const double f : {20.0, 50.0, 200.0}) {
    const double pole = low_pass_pole(f, kDt);
    double y = 0.0, x = 0.0;
    for (int k = 0; k < 2000; ++k) low_pass(pole, x = k * kDt, y);
    EXPECT_NEAR(x - y, low_pass_delay(pole, kDt), 1e-12) << f << " Hz";
  }
  EXPECT_NEAR(low_pass_delay(low_pass_pole(50.0, kDt), kDt), 2.71e-3, 1e-5);  // as docs say
  EXPECT_EQ(low_pass_delay(low_pass_pole(0.0, kDt), kDt), 0.0);
}

TEST(LinkObserver, ForgetsAnErrorWithItsDoublePole) {
  const double pole = low_pass_pole(100.0, kDt);
  LinkObserver link = {.q = 1e-3, .dq = 0.0};  // the joint stands at 0
  // error of the position of a double pole from rest: (A + B k) p^k
  double first = 0.0, second = 0.0;
  for (int k = 1; k <= 12; ++k) {
    observe(pole, kDt, 0.0, 0.0, link);
    if (k == 1) first = link.q;
    if (k == 2) second = link.q;
    const double a = 2.0 * first / pole - second / (pole * pole);
    const double b = second / (pole * pole) - first / pole;
    if (k <= 2) continue;
    ASSERT_NEAR(link.q, (a + b * k) * std::pow(pole, k), 1e-15) << k;
  }
}

TEST(LinkObserver, HasNoDelayWhereTheReferenceIsFollowed) {
  const double pole = low_pass_pole(100.0, kDt);
  LinkObserver link;
  double q = 0.0, dq = 0.0;
  for (int k = 0; k < 500; ++k) {
    const double ddq = 20.0 * std::sin(0.1 * k);
    q += kDt * dq + 0.5 * kDt * kDt * ddq;
    dq += kDt * ddq;
    observe(pole, kDt, ddq, q, link);
    ASSERT_NEAR(link.q, q, 1e-12);
    ASSERT_NEAR(link.dq, dq, 1e-9);
  }
}

TEST(LinkObserver, MakesLessNoiseThanTheDifferenceOfA20BitEncoder) {
  const double pole = low_pass_pole(100.0, kDt);
  const double lsb = kTwoPi / (1 << 20);
  LinkObserver link = {.q = 0.0, .dq = 0.3};
  double worst = 0.0;
  for (int k = 1; k < 5000; ++k) {
    observe(pole, kDt, 0.0, lsb * std::round(0.3 * k * kDt / lsb), link);
    worst = std::max(worst, std::abs(link.dq - 0.3));
  }
  EXPECT_LT(worst, 1.5e-3);  // the difference is wrong by up to 6e-3 rad/s
}

TEST(MotorObserver, FiltersTheDifferenceOfTheEncoder) {
  const double pole = low_pass_pole(200.0, kDt);
  MotorObserver motor;
  for (int k = 1; k <= 20; ++k) {
    observe(pole, kDt, 0.5 * k * kDt, motor);
    ASSERT_NEAR(motor.dtheta, 0.5 * (1.0 - std::pow(pole, k)), 1e-12);
    ASSERT_EQ(motor.theta, 0.5 * k * kDt);
  }
}

}  // namespace
}  // namespace hg::estimation
