#include "bench/times.h"

#include <gtest/gtest.h>

namespace hg::bench {
namespace {

TEST(Times, TheFastestOfEachCounts) {
  Times times;
  times.add(0, 3.0);
  times.add(1, 5.0);
  times.add(0, 4.0);
  times.add(1, 2.0);
  EXPECT_EQ(times.us(), (std::vector{3.0, 2.0}));
}

}  // namespace
}  // namespace hg::bench
