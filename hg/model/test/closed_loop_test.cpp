// Linkages whose ends meet: ChainOptions::loops.
#include "hg/model/closed_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hg/core/test/message_of.h"
#include "hg/model/chain_data.h"

namespace hg::model {
namespace {

std::string body(const std::string& name, double mass, const std::string& xyz) {
  return "<link name='" + name + "'><inertial><origin xyz='" + xyz + "'/><mass value='" +
         std::to_string(mass) +
         "'/><inertia ixx='0.02' iyy='0.02' izz='0.02' ixy='0' ixz='0' iyz='0'/></inertial></link>";
}

std::string hinge(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& xyz, const std::string& range = "") {
  return "<joint name='" + name + "' type='" + (range.empty() ? "continuous" : "revolute") +
         "'><parent link='" + parent + "'/><child link='" + child + "'/><origin xyz='" + xyz +
         "'/><axis xyz='0 -1 0'/>" + range + "</joint>";
}

std::string fixed(const std::string& name, const std::string& parent, const std::string& xyz) {
  return "<link name='" + name + "'/><joint name='" + name + " fix' type='fixed'><parent link='" +
         parent + "'/><child link='" + name + "'/><origin xyz='" + xyz + "'/></joint>";
}

// Links of 0.3, 0.8 and 0.6 m on pivots 0.7 m apart, in the x-z plane: the crank turns. At 0 the
// crank stands up; coupler and rocker are drawn straight along x and up, and do not meet yet.
std::string four_bar(const std::string& crank_range = "", const std::string& rocker_range = "") {
  return "<robot name='four bar'><link name='base'/>" + body("crank", 1.0, "0.02 0 0.15") +
         body("coupler", 2.0, "0.4 0.03 0.05") + body("rocker", 1.5, "0 0.01 0.3") +
         hinge("turn", "base", "crank", "0 0 0", crank_range) +
         hinge("middle", "crank", "coupler", "0 0 0.3") +
         hinge("swing", "base", "rocker", "0.7 0 0", rocker_range) +
         fixed("coupler end", "coupler", "0.8 0 0") + fixed("rocker end", "rocker", "0 0 0.6") +
         fixed("grip", "coupler", "0.5 0 0.2") + "</robot>";
}

ChainOptions led_by(const std::string& leader, const std::vector<std::string>& follow,
                    const std::string& tip) {
  ChainOptions options;
  options.loops = {{"coupler end", "rocker end", leader, follow}};
  options.tip_link = tip;
  return options;
}

// by the crank, with the hand on the coupler; by the rocker, with the hand on it
ChainModel by_crank() {
  return ChainModel::from_urdf_text(four_bar(), "bar.urdf",
                                    led_by("turn", {"middle", "swing"}, "grip"));
}
ChainModel by_rocker() {
  return ChainModel::from_urdf_text(
      four_bar("", "<limit lower='-0.3' upper='0.2' velocity='3' effort='9'/>"), "bar.urdf",
      led_by("swing", {"turn", "middle"}, "rocker end"));
}

std::string message_of_loop(const std::string& text, const ChainOptions& options) {
  return message_of([&] { ChainModel::from_urdf_text(text, "bar.urdf", options); });
}

TEST(ClosedLoop, ItsEndsMeetEverywhere) {
  for (const ChainModel& model : {by_crank(), by_rocker()}) {
    ASSERT_EQ(model.nv(), 1);
    ChainData chain(model);
    const int end = model.frame("coupler end"), other = model.frame("rocker end");
    for (double q = -0.299; q < 0.2; q += 0.0071) {
      chain.update_poses(VectorA::Constant(1, q));
      EXPECT_LT((chain.pose(end).p - chain.pose(other).p).norm(), 1e-9) << q;
    }
  }
}

TEST(ClosedLoop, ACrankTurnsWithoutEnd) {
  const ChainModel model = by_crank();
  EXPECT_FALSE(model.joints()[0].position.bounded());
  ChainData chain(model);
  const int grip = model.frame("grip");
  chain.update_poses(VectorA::Constant(1, 1.1));
  const Pose first = chain.pose(grip);
  for (const double turns : {-3.0, 1.0, 12.0}) {
    chain.update_poses(VectorA::Constant(1, 1.1 + turns * 2.0 * M_PI));
    EXPECT_LT((chain.pose(grip).p - first.p).norm(), 1e-9);
    EXPECT_LT((chain.pose(grip).R - first.R).norm(), 1e-9);
  }
}

TEST(ClosedLoop, TwistJacobianAndBiasAreThoseOfItsMotion) {
  for (const ChainModel& model : {by_crank(), by_rocker()}) {
    ChainData chain(model);
    const double q = 0.13, dq = 1.7, step = 1e-5;
    for (const char* name : {"grip", "rocker end", "crank"}) {
      const int frame = model.frame(name);
      const auto at = [&](double position) {
        chain.update_kinematics(VectorA::Constant(1, position), VectorA::Constant(1, dq));
        return chain.twist(frame);
      };
      const Vector6 slope = (at(q + step * dq) - at(q - step * dq)) / (2.0 * step);
      const Vector6 twist = at(q);
      EXPECT_LT((twist - chain.jacobian(frame) * dq).norm(), 1e-12) << name;
      EXPECT_LT((chain.bias_acceleration(frame) - slope).norm(), 1e-5) << name;
      const Vector6 bias = chain.bias_acceleration(frame);
      chain.update(VectorA::Constant(1, q), VectorA::Constant(1, dq));
      EXPECT_LT((chain.bias_acceleration(frame) - bias).norm(), 1e-12) << name;
    }
  }
}

// M, c and gravity from energies alone
TEST(ClosedLoop, ItsDynamicsAreThoseOfItsEnergy) {
  for (const ChainModel& model : {by_crank(), by_rocker()}) {
    ChainData chain(model);
    const double q = 0.11, dq = 1.3, step = 1e-4;
    const auto at = [&](double position) {
      chain.update(VectorA::Constant(1, position), VectorA::Constant(1, dq));
      return Eigen::Vector2d(chain.M()(0, 0), chain.potential_energy());
    };
    const Eigen::Vector2d slope = (at(q + step) - at(q - step)) / (2.0 * step);
    at(q);
    EXPECT_GT(std::abs(slope[0]), 0.02);
    EXPECT_NEAR(chain.gravity()[0], slope[1], 1e-5);
    EXPECT_NEAR(chain.c()[0], 0.5 * slope[0] * dq * dq + slope[1], 1e-5);
    double energy = 0.0;
    for (const auto& [name, mass, com] : {std::tuple("crank", 1.0, Eigen::Vector3d(0.02, 0, 0.15)),
                                          {"coupler", 2.0, Eigen::Vector3d(0.4, 0.03, 0.05)},
                                          {"rocker", 1.5, Eigen::Vector3d(0, 0.01, 0.3)}}) {
      const Vector6 twist = chain.twist(model.frame(name));
      const Eigen::Vector3d omega = twist.tail<3>();
      const Eigen::Vector3d v =
          twist.head<3>() + omega.cross(chain.pose(model.frame(name)).R * com);
      energy += 0.5 * mass * v.squaredNorm() + 0.5 * 0.02 * omega.squaredNorm();
    }
    EXPECT_NEAR(0.5 * chain.M()(0, 0) * dq * dq, energy, 1e-12);
    const VectorA ddq = VectorA::Constant(1, -0.7);
    const VectorA torque =
        chain.inverse_dynamics(VectorA::Constant(1, q), VectorA::Constant(1, dq), ddq);
    EXPECT_NEAR(torque[0], (chain.M() * ddq + chain.c())[0], 1e-10);
  }
}

TEST(ClosedLoop, WhatCannotBeClosedIsRefused) {
  const auto refused = [](const std::string& text, const ChainOptions& options) {
    return message_of_loop(text, options);
  };
  // a rocker that leads meets the dead centres of the crank
  EXPECT_EQ(refused(four_bar("", "<limit lower='-1.5' upper='1.5'/>"),
                    led_by("swing", {"turn", "middle"}, "rocker end"))
                .substr(0, 44),
            "bar.urdf: loop coupler end - rocker end: is ");
  EXPECT_EQ(refused(four_bar("", "<limit lower='-0.1' upper='0.1'/>"),
                    led_by("turn", {"middle", "swing"}, "grip"))
                .substr(0, 62),
            "bar.urdf: loop coupler end - rocker end: joint swing would be ");
  EXPECT_EQ(refused(four_bar(), led_by("turm", {"middle", "swing"}, "grip")),
            "bar.urdf: a joint of a loop must be one of the URDF, got 'turm', nearest is 'turn'");
  EXPECT_EQ(refused(four_bar(), led_by("turn", {"middle", "middle"}, "grip")),
            "bar.urdf: loop coupler end - rocker end: joint middle is named twice");
  EXPECT_EQ(refused(four_bar(), led_by("turn", {"middle"}, "grip")).substr(0, 49),
            "bar.urdf: loop coupler end - rocker end: is open ");
}

}  // namespace
}  // namespace hg::model
