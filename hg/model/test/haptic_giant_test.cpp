#include "hg/model/haptic_giant.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

#include "hg/model/chain_data.h"
#include "hg/model/test/dh_reference.h"
#include "hg/model/test/models.h"

namespace hg::model::haptic_giant {
namespace {

using std::numbers::pi;

constexpr double kRounding = 1e-12;  // lengths of order 1, a dozen products
constexpr int kSamples = 100'000;
constexpr unsigned kSeed = 7;

// a random state of gantry and arm, all joints in (-pi, pi)
struct State {
  Eigen::Vector2d q_p;
  Vector6 q_m;
};

class Random {
 public:
  double between(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(engine_);
  }
  State anywhere() {
    State state;
    for (double& q : state.q_p) q = between(-2.5, 2.5);
    for (double& q : state.q_m) q = between(-pi, pi);
    return state;
  }
  // inside the joint limits of the device
  State operating() {
    State state = anywhere();
    do {
      state.q_m << between(-pi, pi), between(0.20, 2.75), between(-2.6, 2.6), between(0.20, 2.45),
          between(-2.0, 2.1), between(-2.6, 2.1);
    } while (state.q_m[3] + state.q_m[4] < 0.26 || state.q_m[3] + state.q_m[4] > 2.88);
    return state;
  }

 private:
  std::mt19937 engine_{kSeed};
};

double angle_between(const Vector6& a, const Vector6& b) {
  double largest = 0.0;
  for (int i = 0; i < 6; ++i) {
    largest = std::max(largest, std::abs(std::remainder(a[i] - b[i], 2 * pi)));
  }
  return largest;
}

TEST(HapticGiant, LengthsAreThoseOfTheUrdf) {
  const ChainModel chain = haptic_giant_chain();
  const Lengths lengths = lengths_of(chain, chain.frame("handle"));
  const Lengths expected;
  EXPECT_EQ(lengths.L1, expected.L1);
  EXPECT_EQ(lengths.L2, expected.L2);
  EXPECT_EQ(lengths.D3, expected.D3);
  EXPECT_EQ(lengths.L4, expected.L4);
  EXPECT_EQ(lengths.D6, expected.D6);
}

TEST(HapticGiant, PoseAndElbowEqualTableI) {
  Random random;
  for (int i = 0; i < kSamples; ++i) {
    const auto [q_p, q_m] = random.anywhere();
    Eigen::Matrix<double, 8, 1> q;
    q << q_p, q_m;
    const DhFrames expected = dh_frames(q);
    ASSERT_LT(distance(hand_pose(q_p, q_m), expected.hand), kRounding) << q.transpose();
    ASSERT_LT((elbow(q_p, q_m) - expected.elbow.p).norm(), kRounding) << q.transpose();
  }
}

TEST(HapticGiant, EveryBranchReachesThePoseAndOneReturnsTheJoints) {
  // acos is steep at its ends: the angles of a stretched arm lose half of their digits
  constexpr double kRecovered = 2e-6;
  Random random;
  for (int i = 0; i < kSamples; ++i) {
    const auto [q_p, q_m] = random.anywhere();
    const Pose pose = hand_pose(q_p, q_m);
    double nearest = 10.0;
    int solved = 0;
    for (const int f : {1, -1}) {
      for (const int w : {1, -1}) {
        for (const int k : {1, -1}) {
          Vector6 solution;
          if (inverse(pose, q_p, {f, w, k}, solution) != InverseStatus::kSolved) continue;
          ++solved;
          ASSERT_LT(distance(hand_pose(q_p, solution), pose), 1e-10) << q_m.transpose();
          nearest = std::min(nearest, angle_between(solution, q_m));
        }
      }
    }
    ASSERT_LT(nearest, kRecovered) << q_m.transpose();
    ASSERT_TRUE(solved == 8 || solved == 4) << solved << " at " << q_m.transpose();
  }
}

TEST(HapticGiant, BranchNamesTheSignsOfItsSolution) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const auto [q_p, q_m] = random.operating();
    for (const int f : {1, -1}) {
      for (const int w : {1, -1}) {
        for (const int k : {1, -1}) {
          Vector6 q;
          if (inverse(hand_pose(q_p, q_m), q_p, {f, w, k}, q) != InverseStatus::kSolved) continue;
          ASSERT_GT(f * std::sin(q[3] + q[4]), 0.0);
          ASSERT_GT(w * std::sin(q[3]), 0.0);
          ASSERT_GT(k * std::sin(q[1]), 0.0);
        }
      }
    }
  }
}

TEST(HapticGiant, OperatingBranchReturnsTheJoints) {
  constexpr double kRecovered = 1e-10;
  Random random;
  for (int i = 0; i < kSamples; ++i) {
    const auto [q_p, q_m] = random.operating();
    Vector6 solution;
    ASSERT_EQ(inverse(hand_pose(q_p, q_m), q_p, {}, solution), InverseStatus::kSolved);
    ASSERT_LT(angle_between(solution, q_m), kRecovered) << q_m.transpose();
  }
}

TEST(HapticGiant, InverseIsExactWhenTheHandAxisIsVertical) {
  const Eigen::Vector2d q_p(0.2, -0.1);
  for (const double s : {0.0, pi}) {
    for (const auto& [f, lean] : {std::pair{1, 0.0}, {-1, 0.0}, {1, 1e-14}, {-1, 1e-14}}) {
      const Vector6 q_m{{0.3, 1.2, -0.4, 1.1, s - 1.1, 0.7}};
      Pose pose = hand_pose(q_p, q_m);
      pose.R.col(2) << 0.0, 0.0, s == 0.0 ? -1.0 : 1.0;
      pose.R.row(2) = pose.R.col(2).transpose();
      pose.R(0, 2) = lean;
      Vector6 solution;
      ASSERT_EQ(inverse(pose, q_p, {.f = f}, solution), InverseStatus::kSingular);
      EXPECT_LT(distance(hand_pose(q_p, solution), pose), 1e-10) << s << " " << f;
      EXPECT_NEAR(solution[5], 0.0, kRounding);
    }
  }
}

TEST(HapticGiant, InverseReportsWhatIsOutOfReachAndReturnsTheNearest) {
  const Eigen::Vector2d q_p(0.0, 0.0);
  const Vector6 q_m{{0.3, 1.2, -0.4, 1.1, 0.4, 0.7}};
  Pose pose = hand_pose(q_p, q_m);
  Vector6 solution;

  pose.p.z() -= 1.0;
  EXPECT_EQ(inverse(pose, q_p, {}, solution), InverseStatus::kHeightOutOfReach);
  EXPECT_NEAR(solution[3], 0.0, kRounding);
  EXPECT_TRUE(solution.allFinite());
  pose.p.z() += 2.0;
  EXPECT_EQ(inverse(pose, q_p, {}, solution), InverseStatus::kHeightOutOfReach);
  EXPECT_NEAR(std::abs(solution[3]), pi, kRounding);

  pose = hand_pose(q_p, q_m);
  EXPECT_EQ(inverse(pose, {5.0, 5.0}, {}, solution), InverseStatus::kDistanceOutOfReach);
  EXPECT_NEAR(solution[1], 0.0, kRounding);
  const double toward_hand = std::atan2(-1.0, -1.0);
  EXPECT_NEAR(std::remainder(solution[0] - toward_hand, 2 * pi), 0.0, 0.2);
  EXPECT_TRUE(solution.allFinite());
}

TEST(HapticGiant, HeightOutOfReachIsReportedBeforeDistance) {
  Pose pose;
  pose.p << 9.0, 0.0, -9.0;
  Eigen::Vector2d q_p(0.0, 0.0);
  Vector6 solution;
  pose.R = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(inverse(pose, q_p, {}, solution), InverseStatus::kHeightOutOfReach);
  EXPECT_EQ(inverse_at_target(pose, q_p, solution), InverseStatus::kHeightOutOfReach);
}

TEST(HapticGiant, DeterminantEqualsThatOfTheJacobian) {
  ChainData chain(ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf"));
  const int handle = chain.model().frame("handle");
  Random random;
  for (int i = 0; i < 20'000; ++i) {
    const auto [q_p, q_m] = random.anywhere();
    Eigen::VectorXd q(8);
    q << q_p, q_m;
    chain.update_kinematics(q, Eigen::VectorXd::Zero(8));
    const Eigen::Matrix<double, 6, 6> J_m = chain.jacobian(handle).rightCols<6>();
    ASSERT_NEAR(jacobian_determinant(q_m), J_m.determinant(), kRounding) << q_m.transpose();
  }
}

TEST(HapticGiant, GantryTargetBringsJoints2And3ToTheirGoalsAtTheSamePose) {
  Random random;
  for (int i = 0; i < 10'000; ++i) {
    const auto [q_p, q_m] = random.operating();
    const Pose pose = hand_pose(q_p, q_m);
    const Eigen::Vector2d target = gantry_target(q_p, q_m);
    Vector6 goal;
    ASSERT_EQ(inverse(pose, target, {}, goal), InverseStatus::kSolved);
    ASSERT_NEAR(goal[1], pi / 2, 1e-9);
    ASSERT_NEAR(goal[2], -std::atan(0.53 / 0.67), 1e-9);
    ASSERT_LT((gantry_target(target, goal) - target).norm(), 1e-9);
  }
}

TEST(HapticGiant, InverseAtTargetHoldsThePoseInThatPosture) {
  Random random;
  for (int i = 0; i < 10'000; ++i) {
    const auto [q_p, q_m] = random.operating();
    const Pose pose = hand_pose(q_p, q_m);
    Eigen::Vector2d target;
    Vector6 goal;
    ASSERT_EQ(inverse_at_target(pose, target, goal), InverseStatus::kSolved);
    ASSERT_LT(distance(hand_pose(target, goal), pose), 1e-10);
    ASSERT_LT((target - gantry_target(q_p, q_m)).norm(), 1e-9);
    ASSERT_NEAR(goal[1], pi / 2, kRounding);
  }
}

TEST(HapticGiant, NearestTurnFollowsAJointOverManyTurnsBothWays) {
  double unwrapped = 0.0;
  for (const double direction : {1.0, -1.0}) {
    for (int i = 0; i < 1000; ++i) {
      const double truth = unwrapped + direction * 0.05;
      unwrapped = nearest_turn(std::remainder(truth, 2 * pi), unwrapped);
      ASSERT_NEAR(unwrapped, truth, 1e-11);
    }
    EXPECT_NEAR(unwrapped, direction > 0.0 ? 50.0 : 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace hg::model::haptic_giant
