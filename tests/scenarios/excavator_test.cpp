/// Fig. 8, the excavator, phase by phase. Source: [HANDBOOK] 10.2.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "hg/core/linear_algebra.h"
#include "tests/scenarios/trace.h"

namespace hg {
namespace {

constexpr double kNear = 5e-3;        // rad, [HANDBOOK] 10: a limit is hit
constexpr double kConsistent = 1e-2;  // [HANDBOOK] 10.2: accelerations after the hit
enum Joint { kSwing, kBoom, kStick, kBucket };

double stick_speed(const CycleRecord& record) { return record.twin.dq_a[kStick]; }

class Excavator : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { trace_ = std::make_unique<Trace>(law_alone("excavator")); }
  static void TearDownTestSuite() { trace_.reset(); }

  static const Trace& trace() { return *trace_; }
  static int twin_limit(int joint) { return trace_->run().limit("swing") + joint; }
  static const LimitReport& limit(const CycleRecord& record, int joint) {
    return record.limits[twin_limit(joint)];
  }
  static bool only_limit(const CycleRecord& record, int joint) {
    return limit(record, joint).state != LimitState::kInactive &&
           !any_limit(record, 0, twin_limit(joint)) &&
           !any_limit(record, twin_limit(joint) + 1, record.limit_count);
  }
  /// First cycle from `from` on in which a joint is braked by or rests on a position limit.
  static double hit(int joint, LimitState side, double from) {
    return trace_->first(from, [&](const CycleRecord& record) {
      return limit(record, joint).state == side &&
             limit(record, joint).cause == LimitCause::kPosition;
    });
  }

 private:
  static std::unique_ptr<Trace> trace_;
};
std::unique_ptr<Trace> Excavator::trace_;

TEST_F(Excavator, TheDeviceNeverEndsBeforeTheTwinDoes) {
  for (const CycleRecord& record : trace().records()) {
    ASSERT_FALSE(any_position_limit(record, 0, twin_limit(kSwing))) << record.time_s;
  }
}

TEST_F(Excavator, EveryLimitIsFeltWhereItIsMet) {
  EXPECT_EQ(trace().event("boom").felt_limit, twin_limit(kBoom));
  EXPECT_EQ(trace().event("t_a").felt_limit, twin_limit(kBucket));
  // the straight arm presses bucket and stick together, and the stick longer than the bucket
  EXPECT_GE(trace().event("t_b").felt_limit, twin_limit(kStick));
  const double straight = trace().time_of("t_b");
  EXPECT_GT(trace().first(straight,
                          [](const CycleRecord& r) { return r.felt_limit == twin_limit(kStick); }),
            0.0);
  EXPECT_LT(trace().first(straight,
                          [](const CycleRecord& r) { return r.felt_limit == twin_limit(kStick); }),
            straight + 0.2);
  EXPECT_EQ(trace().record(trace().time_of("t_c") + 0.5).felt_limit, twin_limit(kSwing));
  EXPECT_EQ(trace().record(trace().time_of("t_d") + 0.5).felt_limit, twin_limit(kSwing));
}

TEST_F(Excavator, TheStickGivesWayWhenTheBucketEnds) {
  const double hits = hit(kBucket, LimitState::kUpper, trace().time_of("boom") + 0.5);
  ASSERT_NEAR(hits, trace().time_of("t_a"), 0.1);
  const CycleRecord& before = trace().record(hits - 0.005);
  EXPECT_EQ(limit(before, kBoom).state, LimitState::kLower);
  EXPECT_EQ(limit(before, kBoom).cause, LimitCause::kPosition);
  EXPECT_LT(limit(trace().event("t_a"), kBoom).to_lower, kNear);

  const double slow = stick_speed(trace().record(hits));
  EXPECT_GT(slow, 0.0);
  EXPECT_GT(trace().largest(hits, hits + 0.3, stick_speed), std::max(0.6, 2.0 * slow));
}

// Once the bucket rests on its limit, the other joints move as if it was welded to the stick:
// M_rr ddq_r = tau_r - c_r.
TEST_F(Excavator, AfterTheHitTheOtherJointsObeyTheReducedModel) {
  const auto& twin = trace().run().scenario().twin.model;
  model::ChainData chain(twin.chain);
  int compared = 0;
  double most_different = 0.0;
  for (double t = trace().time_of("t_a"); t < trace().time_of("t_a") + 1.0; t += trace().period()) {
    const CycleRecord& record = trace().record(t);
    if (!only_limit(record, kBucket) || std::abs(record.twin.dq_a[kBucket]) > 1e-6) continue;
    chain.update(record.twin.q_a, record.twin.dq_a);
    VectorA load = record.tau_a - chain.c();
    for (int i = 0; i < 4; ++i) {
      load[i] -= twin.dofs[i].damping * record.twin.dq_a[i];
    }
    const Eigen::Vector3d reduced =
        LeastSquares(chain.M().topLeftCorner<3, 3>()).solve(load.head<3>());
    const Eigen::Vector4d free = LeastSquares(chain.M().topLeftCorner<4, 4>()).solve(load);
    const Eigen::Vector3d rendered = record.twin.ddq_a.head<3>();
    ASSERT_LT((rendered - reduced).norm(), kConsistent * reduced.norm()) << record.time_s;
    most_different = std::max(most_different, (free.head<3>() - rendered).norm() / rendered.norm());
    ++compared;
  }
  EXPECT_GT(compared * trace().period(), 0.1);  // s
  EXPECT_GT(most_different, 0.5);               // without the bucket's reaction
}

TEST_F(Excavator, FullyExtendedTheArmIsPressedStraight) {
  const double straight = trace().time_of("t_b");
  EXPECT_LT(limit(trace().record(straight), kStick).to_lower, kNear);
  EXPECT_LT(limit(trace().record(straight), kBucket).to_lower, kNear);
  EXPECT_GT(trace().largest(straight, straight + 0.2,
                            [&](const CycleRecord& r) { return limit(r, kStick).reaction; }),
            3.0);  // Nm
  const double base = trace().run().scenario().twin.T_B_root.p.z();
  EXPECT_NEAR(trace().record(straight).T_B_H.p.z(), base, 0.05);
}

TEST_F(Excavator, TheSwingStopsAtBothEndsWhileTheArmStaysFree) {
  for (const auto& [event, side, sign] :
       {std::tuple{"t_c", LimitState::kLower, 1.0}, std::tuple{"t_d", LimitState::kUpper, -1.0}}) {
    SCOPED_TRACE(event);
    const double holds = trace().time_of(event) + 0.3;
    int free = 0;
    for (double t = holds; t < holds + 1.0; t += trace().period()) {
      const CycleRecord& record = trace().record(t);
      ASSERT_EQ(limit(record, kSwing).state, side) << t;
      ASSERT_NEAR(record.twin.dq_a[kSwing], 0.0, 1e-6) << t;
      ASSERT_GT(sign * limit(record, kSwing).reaction, 0.0) << t;
      if (only_limit(record, kSwing)) ++free;
    }
    EXPECT_GT(free * trace().period(), 0.99);  // s
  }
}

// The axis of the boom is at a right angle to that of the swing, which is vertical.
TEST_F(Excavator, ContactOfTheBoomDoesNotTurnTheSwing) {
  const auto& scenario = trace().run().scenario();
  model::ChainData chain(scenario.twin.model.chain);
  int touching = 0;
  for (const CycleRecord& record : trace().records()) {
    if (!only_limit(record, kBoom)) continue;
    ++touching;
    ASSERT_NEAR(record.budget.limits[kSwing], 0.0, 1e-9) << record.time_s;
    chain.update_kinematics(record.twin.q_a, record.twin.dq_a);
    const Eigen::Vector3d arm =
        chain.pose(scenario.twin.model.end_effector).p - scenario.twin.T_B_root.p;
    const double turning = arm.cross(record.robot.w_H.head<3>()).z() + record.robot.w_H[5];
    ASSERT_NEAR(record.tau_a[kSwing], turning, 1e-9) << record.time_s;
  }
  EXPECT_GT(touching * trace().period(), 1.0);  // s
}

TEST_F(Excavator, TheBucketCurlsWhileDiggingAndIsEmptiedLater) {
  const double digs = trace().time_of("t_e");
  EXPECT_GT(limit(trace().record(digs - 1.0), kBucket).to_upper, 0.2);  // open before
  EXPECT_LT(trace().record(digs).T_B_H.p.z(), trace().record(digs - 2.0).T_B_H.p.z());
  const double empty = trace().time_of("unload");
  EXPECT_LT(trace().record(empty).twin.q_a[kBucket], 0.3);
  EXPECT_GT(trace().record(empty).T_B_H.p.z(), trace().record(digs).T_B_H.p.z() + 0.2);
}

}  // namespace
}  // namespace hg
