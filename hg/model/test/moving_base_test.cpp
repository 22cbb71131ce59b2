// A chain on a moving base, against the same chain behind six joints that make that motion.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hg/core/random.h"
#include "hg/model/chain_data.h"

namespace hg::model {
namespace {

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& axis, const std::string& xyz,
                  const std::string& more = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + xyz +
         "' rpy='0.2 -0.3 0.4'/><axis xyz='" + axis +
         "'/><limit lower='-3' upper='3' velocity='9' effort='99'/>" + more + "</joint>";
}

std::string link(const std::string& name, double mass) {
  if (mass == 0.0) return "<link name='" + name + "'/>";
  return "<link name='" + name + "'><inertial><origin xyz='0.1 -0.05 0.2'/><mass value='" +
         std::to_string(mass) +
         "'/><inertia ixx='0.03' iyy='0.04' izz='0.05' ixy='0.001' ixz='0.002' iyz='-0.003'/>"
         "</inertial></link>";
}

// Two turns and a slide; `mimic` couples the slide to the first turn.
std::string arm(bool has_mimic) {
  const std::string mimic = has_mimic ? "<mimic joint='a' multiplier='0.3' offset='0.1'/>" : "";
  return link("root", 2.0) + link("l1", 1.5) + link("l2", 0.8) + link("tip", 0.5) +
         joint("a", "revolute", "root", "l1", "0 0 1", "0.1 0.2 0.3") +
         joint("b", "revolute", "l1", "l2", "0.6 0 0.8", "0.4 0 0.1") +
         joint("c", "prismatic", "l2", "tip", "0 1 0", "0 0.3 0", mimic);
}

std::string on_carrier(bool has_mimic) {
  const std::vector<std::string> names = {"x", "y", "z", "rz", "ry", "rx"};
  const std::vector<std::string> axes = {"1 0 0", "0 1 0", "0 0 1", "0 0 1", "0 1 0", "1 0 0"};
  std::string text = link("world", 0.0);
  std::string parent = "world";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string child = i + 1 < names.size() ? "carrier_" + names[i] : "root";
    if (child != "root") text += link(child, 1e-3);
    text += joint(names[i], i < 3 ? "prismatic" : "revolute", parent, child, axes[i], "0.3 0 0.1");
    parent = child;
  }
  return "<robot name='r'>" + text + arm(has_mimic) + "</robot>";
}

VectorA values(Random& random, int count, double most) {
  VectorA v(count);
  for (int i = 0; i < count; ++i) v[i] = random.between(-most, most);
  return v;
}

void compare(bool has_mimic, bool has_gravity) {
  const int own = has_mimic ? 2 : 3;
  ChainData carried(
      ChainModel::from_urdf_text(on_carrier(has_mimic), "carrier", {.gravity = has_gravity}));
  ChainData moved(ChainModel::from_urdf_text("<robot name='r'>" + arm(has_mimic) + "</robot>",
                                             "arm", {.gravity = has_gravity, .moving_base = true}));
  ASSERT_EQ(moved.model().nv(), own);
  ASSERT_EQ(moved.model().joints().front().name, "a");
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    SCOPED_TRACE(trial);
    const VectorA q = values(random, 6 + own, 1.2), dq = values(random, 6 + own, 2.0),
                  ddq = values(random, 6 + own, 5.0);
    const VectorA q_own = q.tail(own), dq_own = dq.tail(own), ddq_own = ddq.tail(own);
    carried.update(q, dq);
    const int root = carried.model().frame("root");
    const Vector6 acceleration = carried.jacobian(root) * ddq + carried.bias_acceleration(root);
    moved.move_base(carried.pose(root), carried.twist(root), acceleration);

    const auto check_frames = [&] {
      for (const char* name : {"root", "l1", "l2", "tip"}) {
        SCOPED_TRACE(name);
        const int there = carried.model().frame(name), here = moved.model().frame(name);
        EXPECT_TRUE(moved.pose(here).p.isApprox(carried.pose(there).p, 1e-12));
        EXPECT_TRUE(moved.pose(here).R.isApprox(carried.pose(there).R, 1e-12));
        EXPECT_TRUE(moved.twist(here).isApprox(carried.twist(there), 1e-11));
        const Vector6 whole = carried.jacobian(there) * ddq + carried.bias_acceleration(there);
        EXPECT_TRUE((moved.jacobian(here) * ddq_own + moved.bias_acceleration(here))
                        .isApprox(whole, 1e-10));
        EXPECT_TRUE((moved.jacobian(here) * dq_own + moved.carried_twist(here))
                        .isApprox(moved.twist(here), 1e-11));
      }
    };
    moved.update_kinematics(q_own, dq_own);
    check_frames();
    moved.update(q_own, dq_own);
    check_frames();
    const VectorA torque = carried.inverse_dynamics(q, dq, ddq).tail(own);
    EXPECT_TRUE((moved.M() * ddq_own + moved.c()).isApprox(torque, 1e-10));
    EXPECT_TRUE(moved.inverse_dynamics(q_own, dq_own, ddq_own).isApprox(torque, 1e-10));
    EXPECT_TRUE(moved.gravity().isApprox(carried.gravity().tail(own), 1e-10) || !has_gravity);
    EXPECT_TRUE(moved.M().isApprox(carried.M().bottomRightCorner(own, own), 1e-10));
  }
}

TEST(MovingBase, CarriesAChainAsJointsBeforeItDo) {
  compare(false, true);
  compare(false, false);
}

TEST(MovingBase, CarriesCoupledJoints) { compare(true, true); }

TEST(MovingBase, RestsAtItsPlacementAtFirst) {
  const Pose T{{0.3, -0.2, 0.5}, Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).matrix()};
  const std::string text = "<robot name='r'>" + arm(false) + "</robot>";
  ChainData fixed(ChainModel::from_urdf_text(text, "arm", {.T_B_root = T}));
  ChainData moving(ChainModel::from_urdf_text(text, "arm", {.T_B_root = T, .moving_base = true}));
  const VectorA q = VectorA::Constant(3, 0.4), dq = VectorA::Constant(3, -0.9);
  fixed.update(q, dq);
  moving.update(q, dq);
  const int tip = fixed.model().frame("tip");
  EXPECT_TRUE(moving.pose(tip).p.isApprox(fixed.pose(tip).p, 1e-14));
  EXPECT_TRUE(moving.twist(tip).isApprox(fixed.twist(tip), 1e-14));
  EXPECT_TRUE(moving.c().isApprox(fixed.c(), 1e-13));
  EXPECT_NEAR(moving.potential_energy(), fixed.potential_energy(), 1e-12);
}

// Newton: on a base that accelerates with a, a free body that rests in it needs m a.
TEST(MovingBase, AFreeBodyFeelsItsInertiaAlone) {
  ChainData body(ChainModel::free_body({.mass = 4.0}, {.gravity = false, .moving_base = true}));
  ASSERT_EQ(body.model().nv(), 6);
  Vector6 acceleration;
  acceleration << 1.0, -2.0, 0.5, 0.0, 0.0, 0.0;
  const Vector6 twist = (Vector6() << 0.3, 0.2, 0.1, 0.0, 0.0, 0.0).finished();
  body.move_base({}, twist, Vector6::Zero());
  body.update(body.model().neutral(), VectorA::Zero(6));
  EXPECT_TRUE(body.c().isZero(1e-14)) << "uniform motion is not felt";
  body.move_base({}, twist, acceleration);
  body.update(body.model().neutral(), VectorA::Zero(6));
  EXPECT_TRUE(body.c().head<3>().isApprox(4.0 * acceleration.head<3>(), 1e-13));
  EXPECT_TRUE(body.c().tail<3>().isZero(1e-13));
}

}  // namespace
}  // namespace hg::model
