#include <gtest/gtest.h>

#include <complex>

#include "hg/simulator/sensors/encoder.h"
#include "hg/simulator/sensors/torque_sensor.h"
#include "hg/simulator/test/statistics.h"

namespace hg::simulator {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

RandomStream stream(std::uint64_t seed = 1) {
  return RandomStream(seed, RandomEffect::kLinkEncoder, 0);
}

// Amplitude of the wave that `read` has `waves` times in the interval from 0 to `length`.
template <class Read>
double amplitude(Read read, double length, int waves) {
  constexpr int kPoints = 1000;
  std::complex<double> sum = 0.0;
  for (int k = 0; k < kPoints; ++k)
    sum += read(length * k / kPoints) * std::polar(1.0, -kTurn * waves * k / kPoints);
  return 2.0 * std::abs(sum) / kPoints;
}

TEST(Encoder, QuantisationErrorIsEvenlySpreadOverOneLsb) {
  const double lsb = kTurn / (1 << 20);
  const Encoder encoder({.resolution = lsb}, 1.0, stream());
  RandomStream random(3, RandomEffect::kWrenchNoise);
  std::vector<double> errors(200'000), share(10);
  for (double& error : errors) {
    const double q = 6.0 * random.uniform() - 3.0;
    const double y = encoder.reading(q);
    EXPECT_NEAR(std::remainder(y, lsb), 0.0, 1e-12);
    error = (y - q) / lsb;
    const double bin = std::floor(10.0 * (error + 0.5));
    ASSERT_TRUE(bin >= 0.0 && bin < 10.0) << error;
    share[static_cast<int>(bin)] += 1.0 / 200'000;
  }
  for (double each : share) EXPECT_NEAR(each, 0.1, 0.004);
  EXPECT_NEAR(mean(errors), 0.0, 0.004);
  EXPECT_NEAR(covariance(errors, errors), 1.0 / 12.0, 0.001);
}

TEST(Encoder, BehindAGearItsStepsAreSmallerByTheRatio) {
  const Encoder encoder({.resolution = kTurn / (1 << 17)}, 121.0, stream());
  const double lsb = 3.96e-7;  // [HANDBOOK] 1.2: 4.0e-7
  double before = encoder.reading(0.0), smallest = 1.0;
  for (int k = 1; k < 1000; ++k) {
    const double y = encoder.reading(k * 1e-8);
    if (y != before) smallest = std::min(smallest, y - before);
    before = y;
  }
  EXPECT_NEAR(smallest, lsb, 1e-9);
}

TEST(Encoder, ErrorsRepeatOnceAndTwicePerTurnOfItsOwnShaft) {
  const EncoderConfig config = {.error_1 = 3e-4, .error_2 = 7e-5};
  for (double ratio : {1.0, 101.0}) {
    const Encoder encoder(config, ratio, stream());
    const auto error = [&](double q) { return encoder.reading(q) - q; };
    EXPECT_NEAR(amplitude(error, kTurn / ratio, 1), config.error_1, 1e-12);
    EXPECT_NEAR(amplitude(error, kTurn / ratio, 2), config.error_2, 1e-12);
  }
}

TEST(Encoder, ErrorsOfALinearScaleRepeatWithItsPeriod) {
  const Encoder encoder({.error_1 = 2e-4, .period = 0.5}, 1.0, stream());
  const auto error = [&](double q) { return encoder.reading(q) - q; };
  EXPECT_NEAR(amplitude(error, 1.0, 2), 2e-4, 1e-12);
}

TEST(Encoder, EachOneHasItsOwnOffsetAndPhases) {
  std::vector<double> offsets, starts;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    offsets.push_back(Encoder({.offset = 2e-4}, 1.0, stream(seed)).reading(1.0) - 1.0);
    starts.push_back(Encoder({.error_1 = 1e-3}, 1.0, stream(seed)).reading(0.0));
  }
  EXPECT_NEAR(mean(offsets), 0.0, 5.0 * 2e-4 / std::sqrt(4000.0));
  EXPECT_NEAR(deviation(offsets), 2e-4, 1e-5);
  EXPECT_NEAR(deviation(starts), 1e-3 / std::sqrt(2.0), 4e-5);  // of a sine with any phase
}

TEST(Encoder, WithoutErrorsItIsExact) {
  const Encoder encoder({}, 121.0, stream());
  for (double q : {-3.0, 0.1, 700.0}) EXPECT_EQ(encoder.reading(q), q);
}

constexpr TorqueSensorConfig kExact = {.noise = 0.0,
                                       .gain_error = 0.0,
                                       .offset = 0.0,
                                       .ripple = 0.0,
                                       .range = kInfinity,
                                       .resolution = 0.0};

TorqueSensor torque_sensor(const TorqueSensorConfig& config, std::uint64_t seed = 1) {
  return TorqueSensor(config, 176.0, 121.0, RandomStream(seed, RandomEffect::kTorqueErrors),
                      RandomStream(seed, RandomEffect::kTorqueNoise));
}

TEST(TorqueSensor, WithoutErrorsItIsExact) {
  TorqueSensor sensor = torque_sensor(kExact);
  for (double tau : {-500.0, 0.0, 12.3}) EXPECT_EQ(sensor.sample(tau, 0.4), tau);
}

TEST(TorqueSensor, NoiseIsWhiteWithAShareOfTheFullScale) {
  TorqueSensorConfig config = kExact;
  config.noise = 3e-4;
  TorqueSensor sensor = torque_sensor(config);
  std::vector<double> y(100'000);
  for (double& value : y) value = sensor.sample(20.0, 0.0);
  EXPECT_NEAR(mean(y), 20.0, 1e-3);
  EXPECT_NEAR(deviation(y), 0.0528, 6e-4);  // [HANDBOOK] 1.2: 0.05 Nm
  EXPECT_NEAR(correlation(y, y, 1), 0.0, 0.016);
}

TEST(TorqueSensor, GainAndOffsetBelongToEachSensor) {
  TorqueSensorConfig config = kExact;
  config.gain_error = 3e-3;
  config.offset = 2e-3;
  std::vector<double> gains, offsets;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    TorqueSensor sensor = torque_sensor(config, seed);
    offsets.push_back(sensor.sample(0.0, 0.0));
    gains.push_back((sensor.sample(100.0, 0.0) - offsets.back()) / 100.0);
    EXPECT_EQ(sensor.sample(0.0, 0.0), offsets.back());
  }
  EXPECT_NEAR(mean(gains), 1.0, 5.0 * 3e-3 / std::sqrt(4000.0));
  EXPECT_NEAR(deviation(gains), 3e-3, 2e-4);
  EXPECT_NEAR(deviation(offsets), 2e-3 * 176.0, 0.02);
}

TEST(TorqueSensor, RippleRepeatsTwicePerTurnOfTheMotor) {
  TorqueSensorConfig config = kExact;
  config.ripple = 2e-3;
  TorqueSensor sensor = torque_sensor(config);
  const auto read = [&](double theta) { return sensor.sample(0.0, theta); };
  EXPECT_NEAR(amplitude(read, kTurn / 121.0, 2), 2e-3 * 176.0, 1e-9);
  EXPECT_NEAR(amplitude(read, kTurn / 121.0, 1), 0.0, 1e-9);
}

TEST(TorqueSensor, ReadingsEndAtTheRangeAndComeInSteps) {
  TorqueSensorConfig config = kExact;
  config.range = 1.5;
  EXPECT_DOUBLE_EQ(torque_sensor(config).sample(300.0, 0.0), 264.0);
  EXPECT_DOUBLE_EQ(torque_sensor(config).sample(-300.0, 0.0), -264.0);
  config.resolution = 1e-3;
  EXPECT_DOUBLE_EQ(torque_sensor(config).sample(1.0, 0.0), 6 * 0.176);
}

}  // namespace
}  // namespace hg::simulator
