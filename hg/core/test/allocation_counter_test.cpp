#include "hg/core/allocation_counter.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>
#include <thread>

namespace hg {
namespace {

#ifndef HG_SANITIZED

TEST(AllocationCounter, SeesNewAndTheAlignedAllocationsOfEigen) {
  AllocationCounter counter;
  auto number = std::make_unique<int>(1);
  EXPECT_EQ(counter.count(), 1u);
  Eigen::VectorXd vector(100);
  EXPECT_EQ(counter.count(), 2u);
  vector.setZero();
}

TEST(AllocationCounter, IgnoresOtherThreads) {
  std::thread other;
  AllocationCounter counter;
  const auto before = counter.count();
  other = std::thread([] { auto block = std::make_unique<char[]>(1000); });
  const auto of_thread_start = counter.count() - before;
  other.join();
  EXPECT_EQ(counter.count(), before + of_thread_start);
}

#endif

}  // namespace
}  // namespace hg
