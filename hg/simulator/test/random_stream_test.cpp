#include "hg/simulator/random_stream.h"

#include <gtest/gtest.h>

#include "hg/simulator/test/statistics.h"

namespace hg::simulator {
namespace {

constexpr std::size_t kMany = 200'000;
const double kChance = 5.0 / std::sqrt(kMany);  // five standard deviations of a mean of such

template <class Draw>
std::vector<double> draws(RandomStream stream, Draw draw) {
  std::vector<double> values(kMany);
  for (double& value : values) value = draw(stream);
  return values;
}
double uniform(RandomStream& stream) { return stream.uniform(); }
double gaussian(RandomStream& stream) { return stream.gaussian(); }

double moment(const std::vector<double>& x, int power) {
  double sum = 0.0;
  for (double value : x) sum += std::pow(value, power);
  return sum / static_cast<double>(x.size());
}

TEST(RandomStream, UniformNumbersFillTheirIntervalEvenly) {
  const auto x = draws(RandomStream(1, RandomEffect::kWrenchNoise), uniform);
  std::vector<double> share(20);
  for (double value : x) {
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    share[static_cast<int>(value * 20.0)] += 1.0 / kMany;
  }
  for (double each : share) EXPECT_NEAR(each, 0.05, 0.22 * kChance);  // sqrt(0.05 0.95)
}

TEST(RandomStream, GaussianNumbersHaveTheMomentsAndTailsOfANormalDistribution) {
  const auto x = draws(RandomStream(1, RandomEffect::kWrenchNoise), gaussian);
  EXPECT_NEAR(moment(x, 1), 0.0, kChance);
  EXPECT_NEAR(moment(x, 2), 1.0, std::sqrt(2.0) * kChance);
  EXPECT_NEAR(moment(x, 3), 0.0, std::sqrt(15.0) * kChance);
  EXPECT_NEAR(moment(x, 4), 3.0, std::sqrt(96.0) * kChance);
  double beyond = 0.0;
  for (double value : x) beyond += std::abs(value) > 3.0 ? 1.0 / kMany : 0.0;
  EXPECT_NEAR(beyond, 0.0027, 0.052 * kChance);
}

TEST(RandomStream, StreamsOfEffectsChannelsAndSeedsAreIndependent) {
  std::vector<std::vector<double>> streams;
  for (std::uint64_t seed : {1u, 2u})
    for (const RandomEffect effect :
         {RandomEffect::kLinkEncoder, RandomEffect::kMotorEncoder, RandomEffect::kGyroscopeDrift})
      for (int channel : {0, 1, 5})
        streams.push_back(draws(RandomStream(seed, effect, channel), gaussian));
  for (std::size_t i = 0; i < streams.size(); ++i) {
    EXPECT_NEAR(correlation(streams[i], streams[i], 1), 0.0, kChance);
    EXPECT_NEAR(correlation(streams[i], streams[i], 2), 0.0, kChance);
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t lag : {0u, 1u})
        EXPECT_NEAR(correlation(streams[i], streams[j], lag), 0.0, kChance) << i << " and " << j;
  }
}

TEST(RandomStream, TheSameSeedGivesTheSameNumbers) {
  EXPECT_EQ(draws(RandomStream(7, RandomEffect::kTorqueNoise, 3), gaussian),
            draws(RandomStream(7, RandomEffect::kTorqueNoise, 3), gaussian));
  EXPECT_NE(RandomStream(7, RandomEffect::kTorqueNoise, 3).uniform(),
            RandomStream(8, RandomEffect::kTorqueNoise, 3).uniform());
}

}  // namespace
}  // namespace hg::simulator
