#include "hg/device/franka/estimate.h"

#include <gtest/gtest.h>

namespace hg::franka {
namespace {

RobotState at_identity() {
  RobotState state{};
  const std::array<float, 16> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  state.T_F_ee = state.T_ee_K = identity;
  return state;
}

TEST(UserWrench, IsTheOppositeOfTheRobotsOwn) {
  RobotState state = at_identity();
  state.K_F_ext_hat_K = {1, 2, 3, 4, 5, 6};
  const Vector6 expected{{-1, -2, -3, -4, -5, -6}};
  EXPECT_EQ(user_wrench(state, Pose()), expected);
}

// K lies 0.1 m behind the flange along z and is turned by 90 degrees about it: x_K = y_F
TEST(UserWrench, IsMovedAndTurnedToTheSensor) {
  RobotState state = at_identity();
  state.T_F_ee = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  state.T_ee_K = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.1F, 1};
  state.K_F_ext_hat_K = {-10, 0, 0, 0, 0, 0};  // the user pushes along x_K
  Vector6 expected{{0, 10, 0, -1, 0, 0}};      // z x y = -x
  EXPECT_LT((user_wrench(state, Pose()) - expected).norm(), 1e-6);
  // S at K: no lever
  expected.tail<3>().setZero();
  EXPECT_LT((user_wrench(state, {.p = {0, 0, 0.1}}) - expected).norm(), 1e-6);
}

TEST(CheckWeight, FindsSignAndFrame) {
  const Eigen::Vector3d weight(0, 0, 3.4);
  EXPECT_EQ(check_weight(weight, weight), SignCheck::kRight);
  EXPECT_EQ(check_weight({0.5, -0.5, 3.0}, weight), SignCheck::kRight);
  EXPECT_EQ(check_weight(-weight, weight), SignCheck::kWrong);
  EXPECT_EQ(check_weight({3.4, 0, 0}, weight), SignCheck::kWrong);
  EXPECT_EQ(check_weight({0, 0, 0.1}, weight), SignCheck::kUnseen);
  EXPECT_EQ(check_weight({0, 0, 0.5}, {0, 0, 0.5}), SignCheck::kUnseen);
}

TEST(Objection, NamesWhatIsWrongAtRest) {
  const VectorM weight{{0, -28, 0, 20, 0, 2, 0}};
  RestingEstimate good;
  good.has_any = true;
  good.w_S[0] = 5.0;
  EXPECT_EQ(objection(good, weight), "");
  RestingEstimate bad = good;
  bad.fastest = 0.1;
  EXPECT_NE(objection(bad, weight).find("the arm moves"), std::string::npos);
  bad = good;
  bad.tau_ext = -weight;  // whatever its sign
  EXPECT_NE(objection(bad, weight).find("28.0 Nm in joint 2"), std::string::npos);
  bad = good;
  bad.w_S[5] = 3.0;
  EXPECT_NE(objection(bad, weight).find("let go of the handle"), std::string::npos);
}

}  // namespace
}  // namespace hg::franka
