// Joints that follow others: <mimic> of a URDF and ChainOptions::couplings.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/model/urdf_parts.h"

namespace hg::model {
namespace {

constexpr double kTiny = 1e-12;

std::string body(const std::string& name, const std::string& xyz, double mass, double inertia) {
  const std::string i = std::to_string(inertia);
  return "<link name='" + name + "'><inertial><origin xyz='" + xyz + "'/><mass value='" +
         std::to_string(mass) + "'/><inertia ixx='" + i + "' iyy='" + i + "' izz='" + i +
         "' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& inside) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + inside + "</joint>";
}

// a crank with a handle; a wheel beside it is driven by gears, a nut on it by a thread
const std::string kGears =
    "<robot name='gears'>\n<link name='base'/>" + body("crank", "0 0 0", 2.0, 0.3) +
    body("wheel", "0 0 0", 3.0, 0.2) + body("tip", "0 0 0", 1.0, 0.01) +
    joint("turn", "revolute", "base", "crank",
          "<axis xyz='0 0 1'/><limit lower='-3' upper='3' velocity='8' effort='9'/>"
          "<dynamics damping='0.1' friction='0.5'/>") +
    joint("gear", "revolute", "base", "wheel",
          "<origin xyz='0.5 0 0'/><axis xyz='0 0 1'/><limit lower='-4' upper='5' velocity='6' "
          "effort='9'/><dynamics damping='0.02' friction='0.3'/>"
          "<mimic joint='turn' multiplier='-2' offset='1'/>") +
    joint("hold", "fixed", "crank", "tip", "<origin xyz='0.2 0 0'/>") + "</robot>";

// an arm of three joints in space with a branch on its second link
std::string arm(const std::string& mimic_of_third, const std::string& mimic_of_branch) {
  return "<robot name='arm'><link name='base'/>" + body("upper", "0.2 0.1 0.05", 2.0, 0.03) +
         body("lower", "0.1 0 0.1", 1.5, 0.02) + body("hand", "0.05 0.02 0.1", 1.0, 0.01) +
         body("counter", "-0.1 0.3 0.1", 2.5, 0.04) +
         joint("a", "continuous", "base", "upper", "<axis xyz='0 1 0'/>") +
         joint("b", "continuous", "upper", "lower",
               "<origin xyz='0.4 0 0' rpy='0.3 0.2 0'/><axis xyz='0 0 1'/>") +
         joint("c", "continuous", "lower", "hand",
               "<origin xyz='0.3 0.1 0' rpy='0.5 0 0.4'/><axis xyz='1 0 0'/>" + mimic_of_third) +
         joint("d", "continuous", "upper", "counter",
               "<origin xyz='-0.1 0.2 0'/><axis xyz='0 0.6 0.8'/>" + mimic_of_branch) +
         "</robot>";
}

ChainModel gears() {
  return ChainModel::from_urdf_text(kGears, "gears.urdf", {.gravity = false, .tip_link = "tip"});
}

std::string message_of(const std::string& text, const ChainOptions& options) {
  try {
    ChainModel::from_urdf_text(text, "arm.urdf", options);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Coupling, AGearPairHasTheInertiaOfTheCrankAndOfTheWheelTimesTheSquareOfTheRatio) {
  ChainData chain(gears());
  ASSERT_EQ(chain.model().nv(), 1);
  chain.update(VectorA::Constant(1, 0.7), VectorA::Constant(1, 2.0));
  const double tip = 0.01 + 1.0 * 0.2 * 0.2;
  EXPECT_NEAR(chain.M()(0, 0), 0.3 + tip + 2.0 * 2.0 * 0.2, kTiny);
  EXPECT_NEAR(chain.c()[0], 0.0, kTiny);
  const VectorA zero = VectorA::Zero(1);
  EXPECT_NEAR(chain.inverse_dynamics(zero, zero, VectorA::Ones(1))[0], chain.M()(0, 0), kTiny);
}

TEST(Coupling, TheFollowerIsWhereItsRatioPutsIt) {
  ChainData chain(gears());
  const int wheel = chain.model().frame("wheel");
  for (const double q : {-1.0, 0.0, 0.4, 2.0}) {
    chain.update_poses(VectorA::Constant(1, q));
    const Eigen::Matrix3d& R = chain.pose(wheel).R;
    EXPECT_NEAR(std::remainder(std::atan2(R(1, 0), R(0, 0)) - (1.0 - 2.0 * q), 2.0 * M_PI), 0.0,
                kTiny);
  }
}

TEST(Coupling, TheLeaderTakesItsShareOfLimitsDampingAndFriction) {
  const ChainModel chain = gears();
  ASSERT_EQ(chain.joints().size(), 1u);
  const Joint& turn = chain.joints()[0];
  EXPECT_EQ(turn.name, "turn");
  EXPECT_DOUBLE_EQ(turn.position.lb, -2.0);  // 1 - 2 q <= 5
  EXPECT_DOUBLE_EQ(turn.position.ub, 2.5);   // 1 - 2 q >= -4
  EXPECT_DOUBLE_EQ(turn.velocity_max, 3.0);
  EXPECT_DOUBLE_EQ(turn.damping, 0.1 + 4.0 * 0.02);
  EXPECT_DOUBLE_EQ(turn.friction, 0.5 + 2.0 * 0.3);
  ASSERT_EQ(chain.couplings().size(), 1u);
  EXPECT_EQ(chain.couplings()[0].joint, "gear");
  EXPECT_EQ(chain.couplings()[0].leader, "turn");
}

TEST(Coupling, AlongAChainEverythingIsThatOfTheWholeChainProjected) {
  for (const bool floats : {false, true}) {
    const ChainOptions options = {.floating_root = floats, .tip_link = "hand"};
    const std::string moving =
        floats ? "<robot name='arm'>" + body("base", "0 0 0", 2.0, 0.1) + arm("", "").substr(37)
               : arm("", "");
    ChainData whole(ChainModel::from_urdf_text(moving, "arm.urdf", options));
    ChainOptions coupled_options = options;
    coupled_options.couplings = {{"b", "c", -1.5, 0.2}};
    ChainData chain(ChainModel::from_urdf_text(moving, "arm.urdf", coupled_options));
    const int nv = whole.model().nv(), nq = whole.model().nq(), b = nv - 2, q_b = nq - 2;
    ASSERT_EQ(chain.model().nv(), nv - 1);

    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(nv, nv - 1);
    G.topLeftCorner(b, b).setIdentity();
    G(b, b) = -1.5;
    G(b + 1, b) = 1.0;
    Eigen::VectorXd q = chain.model().neutral(), dq(nv - 1), ddq(nv - 1);
    for (int i = 0; i < nv - 1; ++i) {
      dq[i] = 0.7 - 0.2 * i;
      ddq[i] = -0.4 + 0.3 * i;
    }
    q.tail(2) << 0.4, -0.6;
    Eigen::VectorXd all = whole.model().neutral();
    all.head(q_b) = q.head(q_b);
    all.tail(2) << 0.2 + 1.5 * 0.6, -0.6;

    chain.update(q, dq);
    whole.update(all, G * dq);
    EXPECT_LT((chain.M() - G.transpose() * whole.M() * G).norm(), kTiny);
    EXPECT_LT((chain.c() - G.transpose() * whole.c()).norm(), kTiny);
    EXPECT_LT((chain.gravity() - G.transpose() * whole.gravity()).norm(), kTiny);
    const int hand = chain.model().frame("hand");
    EXPECT_LT((chain.pose(hand).p - whole.pose(hand).p).norm(), kTiny);
    EXPECT_LT((chain.twist(hand) - whole.twist(hand)).norm(), kTiny);
    EXPECT_LT((chain.twist(hand) - chain.jacobian(hand) * dq).norm(), kTiny);
    EXPECT_LT((chain.bias_acceleration(hand) - whole.bias_acceleration(hand)).norm(), kTiny);
    const VectorA torque = chain.inverse_dynamics(q, dq, ddq);
    EXPECT_LT((torque - (chain.M() * ddq + chain.c())).norm(), 1e-10);
  }
}

// M, c and gravity of one joint from energies alone
TEST(Coupling, ABranchMovesWithItsLeaderAndTakesItsPartOfTheDynamics) {
  const std::string text =
      arm("<mimic joint='a' multiplier='0.5'/>", "<mimic joint='a' multiplier='-2' offset='0.3'/>");
  ChainData chain(ChainModel::from_urdf_text(
      text, "arm.urdf", {.couplings = {{"b", "a", 1.5, 0.1}}, .tip_link = "hand"}));
  ASSERT_EQ(chain.model().nv(), 1);
  const double q = 0.8, dq = 1.3, step = 1e-5;
  const auto at = [&](double position, double speed) {
    chain.update(VectorA::Constant(1, position), VectorA::Constant(1, speed));
  };
  at(q + step, dq);
  const double M_after = chain.M()(0, 0), V_after = chain.potential_energy();
  at(q - step, dq);
  const double M_slope = (M_after - chain.M()(0, 0)) / (2.0 * step);
  const double V_slope = (V_after - chain.potential_energy()) / (2.0 * step);
  at(q, dq);
  EXPECT_GT(std::abs(M_slope), 0.05);
  EXPECT_NEAR(chain.gravity()[0], V_slope, 1e-6);
  EXPECT_NEAR(chain.c()[0], 0.5 * M_slope * dq * dq + V_slope, 1e-6);

  struct Body {
    const char* name;
    double mass, inertia;
    Eigen::Vector3d com;
  };
  const Body bodies[] = {{"upper", 2.0, 0.03, {0.2, 0.1, 0.05}},
                         {"lower", 1.5, 0.02, {0.1, 0.0, 0.1}},
                         {"hand", 1.0, 0.01, {0.05, 0.02, 0.1}},
                         {"counter", 2.5, 0.04, {-0.1, 0.3, 0.1}}};
  double energy = 0.0;  // by the twists of the bodies
  for (const Body& body : bodies) {
    const int frame = chain.model().frame(body.name);
    const Vector6 twist = chain.twist(frame);
    EXPECT_LT((twist - chain.jacobian(frame) * dq).norm(), kTiny) << body.name;
    const Eigen::Vector3d omega = twist.tail<3>();
    const Eigen::Vector3d v = twist.head<3>() + omega.cross(chain.pose(frame).R * body.com);
    energy += 0.5 * body.mass * v.squaredNorm() + 0.5 * body.inertia * omega.squaredNorm();
  }
  EXPECT_NEAR(0.5 * chain.M()(0, 0) * dq * dq, energy, kTiny);
}

TEST(Coupling, JacobianAndBiasOfABranchAreThoseOfItsMotion) {
  const std::string text = arm("", "<mimic joint='b' multiplier='-2' offset='0.3'/>");
  // the branch is on the link before its leader
  ChainData chain(ChainModel::from_urdf_text(text, "arm.urdf", {.tip_link = "hand"}));
  ASSERT_EQ(chain.model().nv(), 3);
  const int counter = chain.model().frame("counter");
  const Eigen::Vector3d q(0.3, -0.5, 0.9), dq(0.7, 1.1, -0.4);
  constexpr double kStep = 1e-5;
  chain.update_kinematics(q + kStep * dq, dq);
  const Vector6 after = chain.twist(counter);
  chain.update_kinematics(q - kStep * dq, dq);
  const Vector6 slope = (after - chain.twist(counter)) / (2.0 * kStep);
  chain.update_kinematics(q, dq);
  EXPECT_LT((chain.twist(counter) - chain.jacobian(counter) * dq).norm(), kTiny);
  EXPECT_LT((chain.bias_acceleration(counter) - slope).norm(), 1e-8);
  EXPECT_EQ(chain.jacobian(counter).col(2).norm(), 0.0);
}

TEST(Coupling, WhatCannotBeCoupledIsRefused) {
  EXPECT_EQ(message_of(kGears, {.couplings = {{"gear", "turn", 0.0, 0.0}}, .tip_link = "tip"}),
            "arm.urdf: joint gear: multiplier must not be 0");
  EXPECT_EQ(message_of(arm("<mimic joint='e'/>", ""), {.tip_link = "hand"}),
            "arm.urdf:1: joint c: must follow a joint that moves on its own between root and tip, "
            "got 'e', nearest is 'a'");
  EXPECT_EQ(message_of(arm("<mimic joint='b'/>", ""),
                       {.couplings = {{"b", "a", 2.0, 0.0}}, .tip_link = "hand"}),
            "arm.urdf:1: joint c: must follow a joint that moves on its own between root and tip, "
            "got 'b', nearest is 'a'");
  EXPECT_EQ(message_of(kGears, {.couplings = {{"gear", "turn", 1.0, 90.0}}, .tip_link = "tip"}),
            "arm.urdf: joint gear: its limits leave no range to joint turn");
  EXPECT_EQ(message_of(kGears, {.couplings = {{"gaer", "turn", 1.0, 0.0}}, .tip_link = "tip"}),
            "arm.urdf: coupled joint must be one of the chain, got 'gaer', nearest is 'gear'");
}

TEST(Coupling, AProgramThatDrawsGetsTheMimicsInTheText) {
  const std::string drawn = with_mimics(
      arm("<mimic joint='a'/>", ""), {{"c", "b", 0.5, 0.25}, {"d", "a", -1, 0}, {"x", "a", 1, 0}});
  EXPECT_EQ(drawn, with_mimics(arm("<mimic joint='b' multiplier='0.5' offset='0.25'/>",
                                   "<mimic joint='a' multiplier='-1' offset='0'/>"),
                               {}));
}

}  // namespace
}  // namespace hg::model
