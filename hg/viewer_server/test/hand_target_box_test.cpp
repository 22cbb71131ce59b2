#include "hg/viewer_server/hand_target_box.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "hg/viewer_server/message_rate.h"
#include "hg/viewer_server/reference_wrench_box.h"

namespace hg::viewer_server {
namespace {

const Eigen::AlignedBox3d kLimits(Eigen::Vector3d(-1, -2, -1.4), Eigen::Vector3d(1, 2, -0.4));

HandTarget dragged_to(double x) { return {true, Eigen::Vector3d(x, 0.0, -1.0), 1.0}; }

TEST(HandTargetBox, GivesTheNewestTargetOnce) {
  HandTargetBox box(kLimits);
  HandTarget target;
  EXPECT_FALSE(box.take(target, 0.0));
  EXPECT_TRUE(box.put(1, dragged_to(0.1), 0.0));
  EXPECT_TRUE(box.put(1, dragged_to(0.2), 0.1));
  ASSERT_TRUE(box.take(target, 0.1));
  EXPECT_TRUE(target.active);
  EXPECT_EQ(target.p_B.x(), 0.2);
  EXPECT_EQ(target.press, 1.0);
  EXPECT_FALSE(box.take(target, 0.2));
}

TEST(HandTargetBox, SilenceOfHalfASecondLetsGoOnce) {
  HandTargetBox box(kLimits);
  HandTarget target;
  box.put(1, dragged_to(0.1), 10.0);
  ASSERT_TRUE(box.take(target, 10.4));
  EXPECT_FALSE(box.take(target, 10.49));
  ASSERT_TRUE(box.take(target, 10.51));
  EXPECT_FALSE(target.active);
  EXPECT_EQ(target.press, 0.0);
  EXPECT_FALSE(box.take(target, 20.0));
}

TEST(HandTargetBox, ATargetThatIsNotPickedUpInTimeIsNeverActive) {
  HandTargetBox box(kLimits);
  HandTarget target;
  box.put(1, dragged_to(0.1), 10.0);
  ASSERT_TRUE(box.take(target, 11.0));
  EXPECT_FALSE(target.active);
}

TEST(HandTargetBox, OnePageDragsUntilItLetsGoLeavesOrIsSilent) {
  HandTarget target;
  const auto second_may_drag = [&](auto&& end_of_first, double now_s) {
    HandTargetBox box(kLimits);
    EXPECT_TRUE(box.put(1, dragged_to(0.1), 0.0));
    EXPECT_FALSE(box.put(2, dragged_to(0.2), 0.1));
    EXPECT_TRUE(box.take(target, 0.1));
    EXPECT_EQ(target.p_B.x(), 0.1);
    end_of_first(box);
    return box.put(2, dragged_to(0.3), now_s);
  };
  EXPECT_FALSE(second_may_drag([](HandTargetBox&) {}, 0.2));
  EXPECT_TRUE(second_may_drag([](HandTargetBox& box) { box.put(1, {}, 0.2); }, 0.2));
  EXPECT_TRUE(second_may_drag([](HandTargetBox& box) { box.leave(1); }, 0.2));
  EXPECT_TRUE(second_may_drag([](HandTargetBox&) {}, 0.7));
  EXPECT_FALSE(second_may_drag([](HandTargetBox& box) { box.leave(2); }, 0.2));
}

TEST(HandTargetBox, NamesThePageThatDragsAndTheOneThatAsksForTheHand) {
  HandTargetBox box(kLimits);
  EXPECT_FALSE(box.ask(2, 0.0));  // it is free
  EXPECT_TRUE(box.put(1, dragged_to(0.1), 0.0));
  EXPECT_EQ(box.holder(0.1).page, 1U);
  EXPECT_EQ(box.holder(0.1).asked_by, 0U);
  EXPECT_FALSE(box.ask(1, 0.1));
  EXPECT_TRUE(box.ask(2, 0.1));
  EXPECT_EQ(box.holder(0.2).asked_by, 2U);
  box.put(1, {}, 0.2);
  EXPECT_EQ(box.holder(0.2).page, 0U);
  EXPECT_EQ(box.holder(0.2).asked_by, 0U);
}

TEST(HandTargetBox, ARequestForTheHandEndsAfterTenSecondsOrWithItsPage) {
  HandTargetBox box(kLimits);
  box.put(1, dragged_to(0.1), 0.0);
  EXPECT_TRUE(box.ask(2, 0.0));
  for (double now_s = 0.1; now_s < 10.3; now_s += 0.2) {
    box.put(1, dragged_to(0.1), now_s);
    EXPECT_EQ(box.holder(now_s).asked_by, now_s < 10.0 ? 2U : 0U) << now_s;
  }
  EXPECT_TRUE(box.ask(2, 10.3));
  box.leave(2);
  EXPECT_EQ(box.holder(10.3).asked_by, 0U);
  EXPECT_EQ(box.holder(10.3).page, 1U);
}

TEST(HandTargetBox, ClampsTargetsToTheLimitsPlusHalfAMetre) {
  rc::check([] {
    Eigen::Vector3d p;
    for (double& x : p) x = *rc::gen::inRange(-100'000, 100'000) * 1e-3;
    HandTargetBox box(kLimits);
    HandTarget target;
    RC_ASSERT(box.put(1, {true, p, 0.0}, 0.0));
    RC_ASSERT(box.take(target, 0.0));
    const Eigen::AlignedBox3d grown(kLimits.min().array() - 0.5, kLimits.max().array() + 0.5);
    RC_ASSERT(grown.contains(target.p_B));
    RC_ASSERT((target.p_B - p).norm() <= grown.exteriorDistance(p) + 1e-12);
  });
}

TEST(ReferenceWrenchBox, ASilentClientsWrenchEndsOnce) {
  ReferenceWrenchBox box;
  Vector6 w;
  std::uint64_t client = 0;
  box.put(7, Vector6::Constant(5.0), 10.0);
  ASSERT_TRUE(box.take(w, client, 10.1));
  EXPECT_EQ(w[0], 5.0);
  EXPECT_FALSE(box.take(w, client, 10.11));
  ASSERT_TRUE(box.take(w, client, 10.13));
  EXPECT_TRUE(w.isZero());
  EXPECT_EQ(client, 0U);
  EXPECT_FALSE(box.take(w, client, 20.0));
}

TEST(MessageRate, AdmitsTheBurstAndThenTheRate) {
  MessageRate rate(200.0);
  int admitted = 0;
  for (int i = 0; i < 1000; ++i) admitted += rate.admit(5.0) ? 1 : 0;
  EXPECT_EQ(admitted, static_cast<int>(200.0));
  for (int i = 1; i <= 10'000; ++i) admitted += rate.admit(5.0 + 1e-3 * i) ? 1 : 0;  // 10 s
  EXPECT_NEAR(admitted, 200.0 + 10.0 * 200.0, 2.0);
}

TEST(MessageRate, SaysHowLongToPauseAfterTooMuch) {
  MessageRate rate(1000.0);
  EXPECT_EQ(rate.charge(1000.0, 5.0), 0.0);
  EXPECT_DOUBLE_EQ(rate.charge(500.0, 5.0), 0.5);
  EXPECT_DOUBLE_EQ(rate.charge(0.0, 5.25), 0.25);
  EXPECT_EQ(rate.charge(0.0, 5.5), 0.0);
}

}  // namespace
}  // namespace hg::viewer_server
