#include "hg/core/spsc_ring.h"

#include <gtest/gtest.h>

#include <thread>

namespace hg {
namespace {

TEST(SpscRing, KeepsTheOrderAndDropsWhatDoesNotFit) {
  SpscRing<int> ring(2);
  EXPECT_TRUE(ring.push(1));
  EXPECT_TRUE(ring.push(2));
  EXPECT_FALSE(ring.push(3));
  EXPECT_EQ(ring.dropped(), 1u);
  int item = 0;
  EXPECT_TRUE(ring.pop(item));
  EXPECT_EQ(item, 1);
  EXPECT_TRUE(ring.push(4));
  EXPECT_TRUE(ring.pop(item));
  EXPECT_EQ(item, 2);
  EXPECT_TRUE(ring.pop(item));
  EXPECT_EQ(item, 4);
  EXPECT_FALSE(ring.pop(item));
}

TEST(SpscRing, TwoThreadsLoseNothingThatWasAccepted) {
  constexpr int kItems = 200'000;
  SpscRing<int> ring(64);
  std::thread producer([&] {
    for (int i = 0; i < kItems; ++i) {
      while (!ring.push(i)) std::this_thread::yield();
    }
  });
  for (int expected = 0; expected < kItems;) {
    int item = -1;
    if (!ring.pop(item)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(item, expected);
    ++expected;
  }
  producer.join();
}

}  // namespace
}  // namespace hg
