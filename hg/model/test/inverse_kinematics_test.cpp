#include "hg/model/inverse_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "hg/core/error.h"
#include "hg/core/rotation.h"
#include "hg/model/chain_data.h"
#include "hg/model/haptic_giant.h"
#include "hg/model/test/models.h"

namespace hg::model {
namespace {

using std::numbers::pi;

constexpr double kSolved = 1e-9;  // m and rad, as promised
constexpr double kGoal = 1e-7;    // m and rad: how near the goals are, where they can be reached
constexpr double kNoWish = std::numeric_limits<double>::quiet_NaN();

Pose pose_at(ChainData& chain, int frame, const Eigen::VectorXd& q) {
  chain.update_kinematics(q, Eigen::VectorXd::Zero(chain.model().nv()));
  return chain.pose(frame);
}

void expect_there(ChainData& chain, const InverseProblem& problem, const InverseResult& result) {
  const Pose pose = pose_at(chain, problem.frame, result.q);
  EXPECT_TRUE(result.is_solved);
  EXPECT_LT((pose.p - problem.T_B_frame.p).norm(), kSolved);
  EXPECT_LT(rotation_between(pose.R, problem.T_B_frame.R).norm(), kSolved);
  EXPECT_TRUE((result.q.array() >= problem.q_min.array()).all()) << result.q.transpose();
  EXPECT_TRUE((result.q.array() <= problem.q_max.array()).all()) << result.q.transpose();
}

// within the limits of the URDF, without goals
InverseProblem problem_of(const ChainModel& chain, const std::string& frame) {
  const int n = chain.nv();
  InverseProblem problem = {.frame = chain.frame(frame),
                            .q_min = Eigen::VectorXd(n),
                            .q_max = Eigen::VectorXd(n),
                            .goal = Eigen::VectorXd::Constant(n, kNoWish)};
  for (int i = 0; i < n; ++i) {
    problem.q_min[i] = chain.joints()[i].position.lb;
    problem.q_max[i] = chain.joints()[i].position.ub;
  }
  return problem;
}

Eigen::VectorXd random_posture(const InverseProblem& problem, std::mt19937& random) {
  Eigen::VectorXd q(problem.q_min.size());
  for (int i = 0; i < q.size(); ++i) {
    const double lb = std::max(problem.q_min[i], -pi), ub = std::min(problem.q_max[i], pi);
    q[i] = std::uniform_real_distribution<double>(lb, ub)(random);
  }
  return q;
}

TEST(InverseKinematics, FindsThePostureOfTheClosedForm) {
  constexpr unsigned kSeed = 3;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  ChainData chain(haptic_giant_chain());
  InverseProblem problem = problem_of(chain.model(), "handle");
  problem.goal[3] = 0.5 * pi;                                                             // m2
  problem.goal[4] = -std::atan2(haptic_giant::Lengths{}.L1, haptic_giant::Lengths{}.L2);  // m3
  problem.q_min[5] = 0.0;  // m4: forearm on one side
  for (int sample = 0; sample < 20; ++sample) {
    Eigen::VectorXd q = random_posture(problem, random);
    q[0] = q[1] = 0.0;
    q.tail<3>() << 1.2, 0.3 * (q[6] > 0.0 ? 1.0 : -1.0), 0.4 * q[7];
    problem.T_B_frame = pose_at(chain, problem.frame, q);
    Eigen::Vector2d q_p;
    Vector6 q_m;
    ASSERT_EQ(haptic_giant::inverse_at_target(problem.T_B_frame, q_p, q_m),
              haptic_giant::InverseStatus::kSolved);
    if ((q_p.array() < problem.q_min.head<2>().array()).any() ||
        (q_p.array() > problem.q_max.head<2>().array()).any()) {
      continue;
    }

    const InverseResult result = inverse_kinematics(chain.model(), problem);
    expect_there(chain, problem, result);
    EXPECT_LT((result.q.head<2>() - q_p).norm(), kGoal);
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(std::remainder(result.q[2 + i] - q_m[i], 2.0 * pi), 0.0, kGoal) << i;
    }
  }
}

TEST(InverseKinematics, ReachesEveryPoseThatAnArmCanTake) {
  constexpr unsigned kSeed = 5;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (const auto& [file, tip] : {std::pair{"ur_description/urdf/ur5_robot.urdf", "tool0"},
                                  std::pair{"z1_description/urdf/z1.urdf", "gripperStator"}}) {
    SCOPED_TRACE(file);
    ChainData chain(example_robot(file, tip));
    InverseProblem problem = problem_of(chain.model(), tip);
    for (int sample = 0; sample < 50; ++sample) {
      problem.T_B_frame = pose_at(chain, problem.frame, random_posture(problem, random));
      expect_there(chain, problem, inverse_kinematics(chain.model(), problem));
    }
  }
}

TEST(InverseKinematics, TakesTheBranchNextToTheGoals) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  ChainData chain(example_robot("ur_description/urdf/ur5_robot.urdf"));
  InverseProblem problem = problem_of(chain.model(), "tool0");
  for (int sample = 0; sample < 50; ++sample) {
    const Eigen::VectorXd q = random_posture(problem, random);
    problem.T_B_frame = pose_at(chain, problem.frame, q);
    problem.goal = q + 0.05 * Eigen::VectorXd::Random(6);
    const InverseResult result = inverse_kinematics(chain.model(), problem);
    expect_there(chain, problem, result);
    EXPECT_LE((result.q - problem.goal).norm(), (q - problem.goal).norm() + kGoal);
  }
}

TEST(InverseKinematics, WithAJointToSpareComesAsNearToTheGoalsAsThePosePermits) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  ChainData chain(example_robot("panda_description/urdf/panda.urdf", "panda_link8"));
  InverseProblem problem = problem_of(chain.model(), "panda_link8");
  Eigen::VectorXd q(7);
  for (int sample = 0; sample < 20; ++sample) {
    q << 0.3, -0.4, 0.2, -2.0, 0.3, 1.8, 0.5;
    for (double& angle : q) angle += std::uniform_real_distribution<double>(-0.3, 0.3)(random);
    problem.T_B_frame = pose_at(chain, problem.frame, q);
    problem.goal = q;
    problem.goal[2] += 0.2;  // the elbow elsewhere
    const InverseResult result = inverse_kinematics(chain.model(), problem);
    expect_there(chain, problem, result);

    // the rest of the way to the goals is orthogonal to the motion that keeps the pose
    pose_at(chain, problem.frame, result.q);
    const Eigen::MatrixXd J = chain.jacobian(problem.frame);
    const Eigen::VectorXd free = J.fullPivLu().kernel().col(0).normalized();
    EXPECT_LT(std::abs(free.dot(problem.goal - result.q)), kGoal);
  }
}

TEST(InverseKinematics, OutOfReachGivesTheNearestPosture) {
  ChainData chain(example_robot("ur_description/urdf/ur5_robot.urdf"));
  InverseProblem problem = problem_of(chain.model(), "tool0");
  problem.T_B_frame.p = {3.0, 0.0, 0.089159};
  const InverseResult result = inverse_kinematics(chain.model(), problem);
  EXPECT_FALSE(result.is_solved);
  const Pose pose = pose_at(chain, problem.frame, result.q);
  EXPECT_NEAR((pose.p - problem.T_B_frame.p).norm(), result.position_error, 1e-12);
  // 0.82 m of arm and the wrist reach 1.0 m; the nearest posture is stretched towards the goal
  EXPECT_GT(result.position_error, 1.9);
  EXPECT_LT(result.position_error, 2.2);
  EXPECT_TRUE((result.q.array() <= problem.q_max.array()).all());
}

TEST(InverseKinematics, StaysWithinLimitsThatForbidTheWay) {
  ChainData chain(example_robot("ur_description/urdf/ur5_robot.urdf"));
  InverseProblem problem = problem_of(chain.model(), "tool0");
  Eigen::VectorXd q(6);
  q << 0.3, -1.2, 1.5, -1.0, -1.5, 0.2;
  problem.T_B_frame = pose_at(chain, problem.frame, q);
  problem.q_max[0] = -0.5;
  problem.q_min[0] = -0.9;
  problem.q_max[2] = 0.4;
  problem.q_min[2] = 0.2;
  const InverseResult result = inverse_kinematics(chain.model(), problem);
  EXPECT_FALSE(result.is_solved);
  EXPECT_TRUE((result.q.array() >= problem.q_min.array()).all());
  EXPECT_TRUE((result.q.array() <= problem.q_max.array()).all());
}

TEST(InverseKinematics, ChoosesAmongTheSolutionsThatThePermissionLeaves) {
  ChainData chain(example_robot("ur_description/urdf/ur5_robot.urdf"));
  InverseProblem problem = problem_of(chain.model(), "tool0");
  Eigen::VectorXd q(6);
  q << 0.3, -1.2, 1.5, -1.0, -1.5, 0.2;
  problem.T_B_frame = pose_at(chain, problem.frame, q);
  problem.goal = q;
  EXPECT_GT(inverse_kinematics(chain.model(), problem).q[2], 0.0);
  problem.permits = [](const Eigen::VectorXd& tried) { return tried[2] < -0.2; };
  const InverseResult other = inverse_kinematics(chain.model(), problem);
  EXPECT_TRUE(other.is_permitted);
  EXPECT_LT(other.q[2], -0.2);
  expect_there(chain, problem, other);

  problem.permits = [](const Eigen::VectorXd&) { return false; };
  const InverseResult none = inverse_kinematics(chain.model(), problem);
  EXPECT_FALSE(none.is_permitted);
  expect_there(chain, problem, none);
  EXPECT_LT((none.q - q).norm(), 1e-6);  // the nearest one
}

TEST(InverseKinematics, KeepsWhatWasReachedWhereTheGoalsLeadToNothingPermitted) {
  ChainData chain(example_robot("panda_description/urdf/panda.urdf", "panda_link8"));
  InverseProblem problem = problem_of(chain.model(), "panda_link8");
  Eigen::VectorXd q(7);
  q << 0.3, -0.4, 0.2, -2.0, 0.3, 1.8, 0.5;
  problem.T_B_frame = pose_at(chain, problem.frame, q);
  problem.goal[2] = 0.4;  // every way to the goals ends here
  ASSERT_NEAR(inverse_kinematics(chain.model(), problem).q[2], 0.4, kGoal);
  problem.permits = [](const Eigen::VectorXd& tried) { return std::abs(tried[2] - 0.4) > 0.01; };
  const InverseResult result = inverse_kinematics(chain.model(), problem);
  EXPECT_TRUE(result.is_permitted);
  EXPECT_LT(std::abs(result.q[2] - 0.4), 0.4);  // not merely another branch
  expect_there(chain, problem, result);
}

TEST(InverseKinematics, GivesTheSameEveryTime) {
  ChainData chain(example_robot("ur_description/urdf/ur5_robot.urdf"));
  InverseProblem problem = problem_of(chain.model(), "tool0");
  problem.T_B_frame.p = {0.4, 0.2, 0.5};
  EXPECT_EQ(inverse_kinematics(chain.model(), problem).q,
            inverse_kinematics(chain.model(), problem).q);
}

TEST(InverseKinematics, RefusesFloatingJoints) {
  const ChainModel chain = mixed_chain();
  EXPECT_THROW(inverse_kinematics(chain, {.frame = 0}), SetupError);
}

}  // namespace
}  // namespace hg::model
