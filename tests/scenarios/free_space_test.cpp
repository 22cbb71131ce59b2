/// Fig. 6, the floating body, phase by phase: the column "what else must be true" of [HANDBOOK]
/// 10.1, as far as records show.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "tests/scenarios/trace.h"

namespace hg {
namespace {

constexpr double kGrasp = 0.7;          // s, script time counts from here
constexpr double kEnd = kGrasp + 48.0;  // s

constexpr double kOvershoot = 2e-3;  // m, [HANDBOOK] 10.1
constexpr double kForce = 2e-3;      // N: v_H is the device's, up to 0.4 mm/s from the twin's
enum Joint { kM1, kM2, kM3, kM4, kM5, kM6 };

class FreeSpace : public ::testing::Test {
 protected:
  // without the tremor of the hand, whose force is not the device's
  static void SetUpTestSuite() {
    config::Scenario scenario = law_alone("free_space");
    scenario.script.hand.tremor_rms = 0.0;
    trace_ = std::make_unique<Trace>(scenario);
  }
  static void TearDownTestSuite() { trace_.reset(); }

  static const Trace& trace() { return *trace_; }
  static int device_limits() { return trace_->run().limit("m1") + 13; }
  static double time_of(const std::string& event) { return trace_->time_of(event); }
  static bool is_felt(const CycleRecord& record, const std::string& name) {
    return record.felt_limit == trace_->run().limit(name);
  }

 private:
  static std::unique_ptr<Trace> trace_;
};
std::unique_ptr<Trace> FreeSpace::trace_;

// 6 kg on a circle of 0.9 m with up to 0.9 m/s take 5.4 N to the middle and 4 Ns/m take 3.6 N along
// the path: 6.4 N, more than the 5 N of the handbook. All of it belongs to the body and nothing to
// the device.
TEST_F(FreeSpace, WalkingInACircleTheHandFeelsNothingButTheBody) {
  const double mass = 6.0;
  const double damping = trace().run().scenario().twin.model.dofs[0].damping;
  int turning = 0;
  for (const CycleRecord& record : trace().records()) {
    if (record.time_s > time_of("t_a")) break;
    ASSERT_FALSE(any_limit(record, 0, record.limit_count)) << record.time_s;
    if (record.mode != Mode::kRunning) continue;
    const Eigen::Vector3d body = mass * record.a_H + damping * record.v_H;
    ASSERT_LT((record.robot.w_H.head<3>() - body).norm(), kForce) << record.time_s;
    ++turning;
  }
  EXPECT_GT(turning * trace().period(), 9.0);  // s
  EXPECT_LT(trace().largest(0.0, time_of("t_a"), force), 6.5);
}

TEST_F(FreeSpace, AtTheElbowsLimitTheHandMovesOn) {
  const double hits = time_of("t_b");
  EXPECT_TRUE(is_felt(trace().record(hits + 0.2), "elbow x"));  // after braking joints m1 and m2
  EXPECT_LE(trace().largest(0.0, kEnd, [](const CycleRecord& r) { return r.p_B_elbow.x(); }),
            1.65 + kOvershoot);
  const double x = trace().record(hits).T_B_H.p.x();
  EXPECT_GT(trace().record(hits + 1.0).T_B_H.p.x(), x + 0.1);
  EXPECT_GT(trace().largest(hits, hits + 1.0, force),
            1.5 * trace().largest(hits - 1.0, hits - 0.2, force));
}

TEST_F(FreeSpace, TheHandPressesHardestAfterItHasReachedItsOwnLimitInX) {
  const double elbow = time_of("t_b"), hand = time_of("t_b'");
  EXPECT_GT(hand, elbow);
  EXPECT_GT(trace().largest(hand, hand + 1.5, force),
            3.0 * trace().largest(elbow, hand, force) / 2);
  EXPECT_TRUE(is_felt(trace().record(hand + 1.0), "hand x"));
  EXPECT_LE(trace().largest(0.0, kEnd, [](const CycleRecord& r) { return r.T_B_H.p.x(); }),
            1.65 + kOvershoot);
}

TEST_F(FreeSpace, TheHandAxisStopsBeforeTheSingularityAndTurningItCostsTorque) {
  const double hits = time_of("t_c");
  const auto s = [](const CycleRecord& r) { return trace().limit(r, "q4+q5").position; };
  EXPECT_GE(trace().smallest(0.0, kEnd, s), 0.26 - 1e-9);
  EXPECT_TRUE(is_felt(trace().record(hits + 0.3), "q4+q5"));
  // a free body of 0.08 kg m^2 needs little: what the hand feels at the limit is its own spring
  EXPECT_GT(std::abs(trace().limit(trace().record(hits + 0.3), "q4+q5").reaction),
            0.9 * torque(trace().record(hits + 0.3)));
}

TEST_F(FreeSpace, JointM4EndsTheHeightOfTheHand) {
  const double hits = time_of("t_e");
  EXPECT_TRUE(is_felt(trace().record(hits + 0.5), "m4"));
  for (double t = hits + 0.1; t < hits + 1.5; t += 0.01) {
    const CycleRecord& record = trace().record(t);
    const double s = record.reference.q_m[kM4] + record.reference.q_m[kM5];
    const double highest = -0.75 - 0.42 * std::cos(2.45) - 0.12 * std::cos(s);
    ASSERT_NEAR(record.T_B_H.p.z(), highest, kOvershoot) << t;
  }
  EXPECT_GT(trace().largest(hits, hits + 1.0, force),
            1.5 * trace().largest(hits - 1.0, hits - 0.1, force));
}

TEST_F(FreeSpace, WhenTheGantryEndsInYTheArmUnfoldsUnnoticed) {
  const double ends = time_of("t_f");
  const double felt =
      trace().first(ends, [](const CycleRecord& r) { return any_limit(r, 0, device_limits()); });
  ASSERT_GT(felt, ends + 0.3);
  EXPECT_LT(trace().largest(ends, felt - 1e-3, force), 6.0);
  EXPECT_LT(trace().largest(ends, kEnd, [](const CycleRecord& r) { return r.robot.q_p[1]; }),
            1.60 + kOvershoot);
  EXPECT_GT(trace().record(felt).reference.q_m[kM2], std::numbers::pi / 2 + 0.5);
  EXPECT_GT(trace().record(felt).T_B_H.p.y(), trace().record(ends).T_B_H.p.y() + 0.1);
  // x stays free: the gantry follows the elbow there
  EXPECT_GT(trace().largest(ends, time_of("t_g") + 1.0,
                            [](const CycleRecord& r) { return std::abs(r.robot.dq_p[0]); }),
            0.1);
}

TEST_F(FreeSpace, AtJointM2sLimitTheForceRisesAndJointM1TurnsFast) {
  const double hits = time_of("t_g");
  EXPECT_GT(trace().largest(hits, hits + 1.5, force), 20.0);
  EXPECT_LT(trace().largest(hits - 1.0, hits - 0.1, force), 6.0);
  const auto m1_speed = [](const CycleRecord& r) { return std::abs(r.reference.dq_m[kM1]); };
  EXPECT_GT(trace().largest(hits, hits + 1.0, m1_speed),
            1.5 * trace().largest(0.0, kGrasp + 15.0, m1_speed));
}

TEST_F(FreeSpace, AtLimitsTheHandPushesMoreThanThreeTimesHarderThanElsewhere) {
  double sum_limited = 0.0, sum_free = 0.0;
  int limited = 0, free = 0;
  for (const CycleRecord& record : trace().records()) {
    if (record.mode != Mode::kRunning) continue;
    const bool is_limited = any_position_limit(record, 0, device_limits());
    (is_limited ? sum_limited : sum_free) += force(record);
    ++(is_limited ? limited : free);
  }
  EXPECT_GT(sum_limited / limited, 3.0 * sum_free / free);
}

// The limit of m6 does work on m6 only: it is a torque about the horizontal heading h of the
// forearm, which neither the vertical axes m1..m3 nor the elbow's axes m4 and m5 feel. It
// accelerates the body about h. With the hand axis at s = m4 + m5 from the vertical, that is one
// part m6 and cos s parts of turning about the vertical; nothing else changes. Both runs are the
// same to the last bit until the limit acts.
TEST(FreeSpaceRoll, TheLimitOfM6ChangesNothingButTheTurnAboutTheHeading) {
  const Trace with(law_alone("free_space"), kGrasp + 29.5);
  config::Scenario scenario = law_alone("free_space");
  scenario.device.model.joint_limits[kM6].q_min = -kInfinity;
  const Trace without(scenario, kGrasp + 29.5);
  const double acts = with.first(kGrasp + 28.0, [&](const CycleRecord& record) {
    return with.limit(record, "m6").state == LimitState::kLower;
  });
  ASSERT_GT(acts, kGrasp + 28.0);
  const CycleRecord &braked = with.record(acts), &free = without.record(acts);
  ASSERT_EQ(braked.reference.q_m, free.reference.q_m);
  const VectorM change = braked.reference.ddq_m - free.reference.ddq_m;
  EXPECT_GT(change[kM6], 1.0);
  EXPECT_NEAR(change[kM4], 0.0, 1e-6);
  EXPECT_NEAR(change[kM5], 0.0, 1e-6);
  EXPECT_LT((braked.a_H - free.a_H).norm(), 1e-6);
  const double s = braked.reference.q_m[kM4] + braked.reference.q_m[kM5];
  EXPECT_NEAR(change.head<3>().sum(), std::cos(s) * change[kM6], 1e-6);

  for (double t = acts; t < acts + 0.5; t += with.period()) {
    ASSERT_LT((with.record(t).T_B_H.p - without.record(t).T_B_H.p).norm(), 1e-3) << t;
  }
}

}  // namespace
}  // namespace hg
