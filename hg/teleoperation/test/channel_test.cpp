#include "hg/teleoperation/channel.h"

#include <gtest/gtest.h>

#include <vector>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"

namespace hg::teleoperation {
namespace {

constexpr double kDt = 1e-3;

struct Numbered {
  int number = 0;
};

struct Arrival {
  int number;
  int period;
};

// Sends one packet per period, numbered from 0, and notes what arrives when.
std::vector<Arrival> arrivals(const ChannelConfig& config, int periods,
                              std::uint64_t direction = 0) {
  Channel<Numbered> channel(config, direction, kDt);
  std::vector<Arrival> arrivals;
  for (int k = 0; k < periods; ++k) {
    channel.send({k}, k * kDt);
    Numbered packet;
    while (channel.receive(k * kDt, packet)) arrivals.push_back({packet.number, k});
  }
  return arrivals;
}

TEST(Channel, DelaysByItsDelay) {
  for (const Arrival& arrival : arrivals({.delay = 0.4}, 1000)) {
    EXPECT_EQ(arrival.period, arrival.number + 400);
  }
  EXPECT_EQ(arrivals({.delay = 0.4}, 1000).size(), 600U);
  for (const Arrival& arrival : arrivals({}, 10)) EXPECT_EQ(arrival.period, arrival.number);
}

TEST(Channel, LosesTheGivenShareAloneOrInBursts) {
  for (const double burst : {0.0, 20.0}) {
    const std::vector<Arrival> all = arrivals({.loss = 0.1, .burst = burst}, 200000);
    EXPECT_NEAR(static_cast<double>(all.size()), 180000.0, 3000.0);
    int gaps = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
      if (all[i].number != all[i - 1].number + 1) ++gaps;
    }
    const double length = (200000.0 - static_cast<double>(all.size())) / gaps;
    EXPECT_NEAR(length, burst > 0.0 ? burst : 1.0 / 0.9, burst > 0.0 ? 2.0 : 0.05);
  }
  EXPECT_TRUE(arrivals({.loss = 1.0}, 100).empty());
}

TEST(Channel, JitterReordersUnlessOrderIsKept) {
  const auto overtakings = [](const std::vector<Arrival>& all) {
    int count = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
      if (all[i].number < all[i - 1].number) ++count;
    }
    return count;
  };
  EXPECT_GT(overtakings(arrivals({.delay = 0.01, .jitter = 0.02}, 2000)), 100);
  EXPECT_EQ(overtakings(arrivals({.delay = 0.01, .jitter = 0.02, .keeps_order = true}, 2000)), 0);
  for (const Arrival& arrival : arrivals({.delay = 0.01, .jitter = 0.02}, 2000)) {
    EXPECT_GE(arrival.period, arrival.number + 10);
    EXPECT_LE(arrival.period, arrival.number + 30);
  }
}

TEST(Channel, LosesEverythingThatIsSentInAnOutage) {
  for (const Arrival& arrival : arrivals({.outages = {{0.1, 0.2}}}, 1000)) {
    EXPECT_TRUE(arrival.number < 100 || arrival.number > 200) << arrival.number;
  }
}

TEST(Channel, IsTheSameForTheSameSeedAndDiffersByDirection) {
  const ChannelConfig config = {.jitter = 0.05, .loss = 0.3, .seed = 7};
  const auto numbers = [&](const ChannelConfig& of, std::uint64_t direction) {
    std::vector<int> list;
    for (const Arrival& arrival : arrivals(of, 500, direction)) list.push_back(arrival.number);
    return list;
  };
  EXPECT_EQ(numbers(config, 0), numbers(config, 0));
  EXPECT_NE(numbers(config, 0), numbers(config, 1));
  ChannelConfig other = config;
  other.seed = 8;
  EXPECT_NE(numbers(config, 0), numbers(other, 0));
}

TEST(Channel, DoesNotAllocateWhileItRuns) {
  Channel<Numbered> channel({.delay = 0.05, .jitter = 0.05}, 0, kDt);
  const AllocationCounter allocations;
  for (int k = 0; k < 2000; ++k) {
    channel.send({k}, k * kDt);
    Numbered packet;
    while (channel.receive(k * kDt, packet)) {
    }
  }
  EXPECT_EQ(allocations.count(), 0U);
}

TEST(Channel, RefusesWhatIsNoLink) {
  EXPECT_THROW(check_channel({.delay = -0.1}), SetupError);
  EXPECT_THROW(check_channel({.loss = 1.1}), SetupError);
  EXPECT_THROW(check_channel({.burst = 0.5}), SetupError);
}

}  // namespace
}  // namespace hg::teleoperation
