#include "hg/device/udp/frame_queue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace hg::udp {
namespace {

// joint 0 turns with 0.5 rad per period without end, the wrench counts periods
SensorFrame frame_at(std::uint64_t sequence) {
  SensorFrame frame;
  const auto k = static_cast<double>(sequence);
  frame.sequence = sequence;
  frame.time_s = 1e-3 * k;
  frame.q_m = VectorM::Constant(6, std::remainder(0.5 * k, 2.0 * std::numbers::pi));
  frame.theta_m = 0.5 * frame.q_m;
  frame.dq_m = VectorM::Constant(6, 0.5);
  frame.q_p = VectorP::Constant(2, 1e-3 * k);
  frame.w_S[0] = k;
  return frame;
}

std::vector<std::uint64_t> pop_all(FrameQueue& queue) {
  std::vector<std::uint64_t> sequences;
  SensorFrame frame;
  while (queue.pop(frame)) sequences.push_back(frame.sequence);
  return sequences;
}

using Sequences = std::vector<std::uint64_t>;

TEST(FrameQueue, BringsFramesIntoTheirOrder) {
  FrameQueue queue;
  queue.push(frame_at(10));
  EXPECT_EQ(pop_all(queue), Sequences{10});
  queue.push(frame_at(12));
  queue.push(frame_at(11));
  EXPECT_EQ(pop_all(queue), (Sequences{11, 12}));
  EXPECT_EQ(queue.held(), 0U);
}

TEST(FrameQueue, ALostFrameIsFilledInWithWhatWouldHaveCome) {
  FrameQueue queue;
  for (const std::uint64_t k : {4, 5, 7}) queue.push(frame_at(k));
  SensorFrame frame;
  queue.pop(frame);
  queue.pop(frame);
  ASSERT_TRUE(queue.pop(frame));
  EXPECT_EQ(frame.sequence, 6U);
  EXPECT_NEAR(frame.time_s, 6e-3, 1e-12);
  EXPECT_NEAR(std::remainder(frame.q_m[0] - frame_at(6).q_m[0], 2.0 * std::numbers::pi), 0, 1e-12);
  EXPECT_NEAR(frame.q_p[1], 6e-3, 1e-12);
  EXPECT_EQ(frame.w_S[0], 5.0);  // stays
  EXPECT_EQ(queue.held(), 1U);
  ASSERT_TRUE(queue.pop(frame));
  EXPECT_EQ(frame.sequence, 7U);
  EXPECT_EQ(frame.q_m, frame_at(7).q_m);
}

TEST(FrameQueue, MotionContinuesThroughAJumpByAWholeTurn) {
  FrameQueue queue;
  for (const std::uint64_t k : {6, 7, 9}) queue.push(frame_at(k));  // 6 -> 7 wraps
  SensorFrame frame;
  for (int i = 0; i < 3; ++i) queue.pop(frame);
  EXPECT_EQ(frame.sequence, 8U);
  EXPECT_NEAR(frame.q_m[0], frame_at(8).q_m[0], 1e-12);
}

TEST(FrameQueue, ThreeInARowAreFilledInAndFourAreNot) {
  FrameQueue queue;
  for (const std::uint64_t k : {1, 2, 6}) queue.push(frame_at(k));
  EXPECT_EQ(pop_all(queue), (Sequences{1, 2, 3, 4, 5, 6}));
  queue.push(frame_at(11));
  EXPECT_EQ(pop_all(queue), Sequences{11});  // the sensor check sees the gap
  EXPECT_EQ(queue.held(), 3U);
}

TEST(FrameQueue, AFrameWhoseTurnIsOverIsRefused) {
  FrameQueue queue;
  for (const std::uint64_t k : {1, 2, 4}) queue.push(frame_at(k));
  pop_all(queue);
  EXPECT_FALSE(queue.push(frame_at(3)));
  EXPECT_FALSE(queue.push(frame_at(4)));
  EXPECT_TRUE(queue.push(frame_at(5)));
  EXPECT_FALSE(queue.push(frame_at(5)));
}

TEST(FrameQueue, WhateverIsLostOrSwappedNoNumberIsMissingOrComesTwice) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::vector<std::uint64_t> arriving;
    bool was_lost = false;  // two lost ones and the one that was overtaken make three
    for (std::uint64_t k = 0; k < 500; ++k) {
      was_lost = k > 0 && !was_lost && random() % 4 == 0;
      if (!was_lost) arriving.push_back(k);
    }
    for (std::size_t i = 2; i < arriving.size(); ++i) {
      if (random() % 5 == 0) std::swap(arriving[i], arriving[i - 1]);
    }
    FrameQueue queue;
    std::uint64_t next = 0;
    for (const std::uint64_t k : arriving) {
      ASSERT_FALSE(queue.is_full());
      queue.push(frame_at(k));
      if (!queue.is_full() && random() % 3 == 0) continue;  // the next comes in the same breath
      SensorFrame frame;
      while (queue.pop(frame)) ASSERT_EQ(frame.sequence, next++);
    }
  }
}

}  // namespace
}  // namespace hg::udp
