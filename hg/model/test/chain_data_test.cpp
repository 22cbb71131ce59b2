#include "hg/model/chain_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/allocation_counter.h"
#include "hg/core/cross.h"
#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"
#include "hg/model/test/dh_reference.h"
#include "hg/model/test/models.h"

namespace hg::model {
namespace {

constexpr double kRounding = 1e-11;   // forces up to 1000 N, a dozen products
constexpr double kStep = 1e-6;        // of central differences
constexpr double kDifference = 1e-6;  // their error at that step: rounding / step
constexpr int kSamples = 50;

// runs `law` on random states of every kind of chain
template <typename Law>
void for_all_chains(Law law) {
  for (const ChainModel& model : all_chains()) {
    ChainData chain(model);
    for (unsigned seed = 0; seed < kSamples; ++seed) {
      SCOPED_TRACE(chain.model().name() + ", seed " + std::to_string(seed));
      RandomState random(seed);
      const Eigen::VectorXd q = random.q(chain);
      law(chain, q, random.vector(chain.model().nv()), random);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(ChainData, AFloatingRootIsTheFirstJointAndStartsAtItsPlacement) {
  ChainData chain(all_chains().back());
  chain.update_kinematics(chain.model().neutral(), Eigen::VectorXd::Zero(7));
  EXPECT_LT(distance(chain.pose(chain.model().frame("body")), slanted()), kRounding);
  EXPECT_EQ(chain.model().joints()[0].name, "root");
  EXPECT_EQ(chain.model().joints()[0].type, JointType::kFloating);
  EXPECT_EQ(chain.model().nv(), 7);
}

TEST(ChainData, TheRootStandsAtItsPlacement) {
  ChainData chain(mixed_chain({.T_B_root = slanted()}));
  ChainData at_origin(mixed_chain());
  const Eigen::VectorXd q = RandomState(1).q(chain);
  const Eigen::VectorXd dq = Eigen::VectorXd::Zero(chain.model().nv());
  chain.update_kinematics(q, dq);
  at_origin.update_kinematics(q, dq);
  EXPECT_LT(distance(chain.pose(chain.model().frame("base")), slanted()), kRounding);
  for (int i = 0; i < static_cast<int>(chain.model().frame_names().size()); ++i) {
    EXPECT_LT(distance(chain.pose(i), slanted() * at_origin.pose(i)), kRounding);
  }
  EXPECT_TRUE(chain.jacobian(chain.model().frame("base")).isZero(0.0));
  EXPECT_TRUE(chain.twist(chain.model().frame("base")).isZero(0.0));
}

TEST(ChainData, FixedLinksAndJointsFollowTheUrdf) {
  // by hand, along the first two joints of mixed_chain()
  ChainData chain(mixed_chain());
  Eigen::VectorXd q = chain.model().neutral();
  q[0] = 0.8;
  q[1] = -0.3;
  chain.update_kinematics(q, Eigen::VectorXd::Zero(chain.model().nv()));
  const auto rpy = [](double r, double p, double y) {
    return (Eigen::AngleAxisd(y, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(p, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(r, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  };
  const Pose turned = {
      Eigen::Vector3d(0.1, 0.2, 0.3),
      rpy(0.4, -0.3, 0.2) *
          Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -3).normalized()).toRotationMatrix()};
  const Pose tool = turned * Pose{Eigen::Vector3d(0.2, -0.1, 0), rpy(0, 0.5, 0.3)};
  const Pose slid = tool * Pose{Eigen::Vector3d(-0.18, 0, 0.4 - 0.24), Eigen::Matrix3d::Identity()};
  EXPECT_LT(distance(chain.pose(chain.model().frame("a")), turned), kRounding);
  EXPECT_LT(distance(chain.pose(chain.model().frame("a_tool")), tool), kRounding);
  EXPECT_LT(distance(chain.pose(chain.model().frame("b")), slid), kRounding);
}

TEST(ChainData, LinksOnFixedJointsAddTheirMassWhereTheyAre) {
  constexpr std::string_view kText = R"(<robot name="flail"><link name="base"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
  </joint>
  <link name="arm"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="weld" type="fixed"><parent link="arm"/><child link="ball"/>
    <origin xyz="0.5 0 0" rpy="1.5707963267948966 0 0"/></joint>
  <link name="ball"><inertial><origin xyz="0 0 0.3"/><mass value="2"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.15" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)";
  ChainData chain(ChainModel::from_urdf_text(kText, "flail.urdf"));
  chain.update(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1));
  EXPECT_NEAR(chain.M()(0, 0), 1.0 + 0.2 + 2.0 * (0.5 * 0.5 + 0.3 * 0.3), kRounding);
}

TEST(ChainData, JacobianAndTwistAreTheDerivativeOfThePose) {
  for_all_chains([](ChainData& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    for (int frame = 0; frame < static_cast<int>(chain.model().frame_names().size()); ++frame) {
      const auto pose_at = [&](double t) {
        chain.update_kinematics(
            Eigen::VectorXd(chain.model().integrate(q, Eigen::VectorXd(dq * t))), dq);
        return chain.pose(frame);
      };
      const Pose before = pose_at(-kStep), after = pose_at(kStep), now = pose_at(0.0);
      Vector6 expected;
      const Eigen::Matrix3d spin = (after.R - before.R) / (2.0 * kStep) * now.R.transpose();
      expected << (after.p - before.p) / (2.0 * kStep), spin(2, 1), spin(0, 2), spin(1, 0);
      ASSERT_LT((chain.twist(frame) - expected).cwiseAbs().maxCoeff(), kDifference);
      ASSERT_LT((chain.jacobian(frame) * dq - chain.twist(frame)).norm(), kRounding);
    }
  });
}

TEST(ChainData, BiasAccelerationIsTheDerivativeOfTheJacobianTimesTheVelocity) {
  for_all_chains([](ChainData& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    for (int frame = 0; frame < static_cast<int>(chain.model().frame_names().size()); ++frame) {
      const auto velocity_at = [&](double t) -> Vector6 {
        chain.update_kinematics(
            Eigen::VectorXd(chain.model().integrate(q, Eigen::VectorXd(dq * t))), dq);
        return chain.jacobian(frame) * dq;
      };
      const Vector6 expected = (velocity_at(kStep) - velocity_at(-kStep)) / (2.0 * kStep);
      chain.update_kinematics(q, dq);
      ASSERT_LT((chain.bias_acceleration(frame) - expected).cwiseAbs().maxCoeff(), kDifference);
    }
  });
}

TEST(ChainData, UpdateContainsTheKinematics) {
  for_all_chains([](ChainData& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    ChainData other(chain);
    chain.update(q, dq);
    other.update_kinematics(q, dq);
    for (int frame = 0; frame < static_cast<int>(chain.model().frame_names().size()); ++frame) {
      ASSERT_LT(distance(chain.pose(frame), other.pose(frame)), kRounding);
      ASSERT_LT((chain.twist(frame) - other.twist(frame)).norm(), kRounding);
      ASSERT_LT((chain.jacobian(frame) - other.jacobian(frame)).norm(), kRounding);
      ASSERT_LT((chain.bias_acceleration(frame) - other.bias_acceleration(frame)).norm(),
                kRounding);
    }
  });
}

TEST(ChainData, PosesAloneAreThoseOfTheKinematicsToTheBit) {
  for_all_chains([](ChainData& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    ChainData other(chain);
    chain.update_poses(q);
    other.update_kinematics(q, dq);
    for (int frame = 0; frame < static_cast<int>(chain.model().frame_names().size()); ++frame) {
      ASSERT_EQ(chain.pose(frame).p, other.pose(frame).p);
      ASSERT_EQ(chain.pose(frame).R, other.pose(frame).R);
    }
  });
}

// Chains with a floating joint are computed by the library, all others by passes of their own.
TEST(ChainData, AFloatingJointAtTheTipChangesNoBitOfWhatIsBeforeIt) {
  constexpr std::string_view kTip = R"(<joint name="tip" type="floating"><parent link="handle"/>
    <child link="tip"/></joint><link name="tip"><inertial><mass value="1e-9"/>
    <inertia ixx="1e-9" iyy="1e-9" izz="1e-9" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)";
  std::vector<std::string> texts = {R"(<robot name="slanted"><link name="base"/>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="a"/>
    <origin xyz="0 0 0.4" rpy="0.4 -0.3 0.2"/><axis xyz="0.6 0 0.8"/>
    <limit lower="-1" upper="1"/></joint><link name="a"><inertial><mass value="1"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="turn" type="continuous"><parent link="a"/><child link="handle"/>
    <origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/><axis xyz="1 2 -3"/></joint>
    <link name="handle"><inertial><origin xyz="0.3 0 0"/><mass value="2"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.2" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)"};
  for (const char* file : {"haptic_giant/haptic_giant.urdf", "twins/door/door.urdf"}) {
    std::ifstream stream(std::string("models/") + file);
    texts.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  for (std::string& text : texts) {
    const ChainOptions options = {.T_B_root = slanted()};
    ChainData chain(ChainModel::from_urdf_text(text, "chain.urdf", options));
    ChainData tipped(ChainModel::from_urdf_text(text.replace(text.rfind("</robot>"), 8, kTip),
                                                "tipped.urdf", options));
    const int n = chain.model().nv(), handle = chain.model().frame("handle");
    for (unsigned seed = 0; seed < kSamples; ++seed) {
      RandomState random(seed);
      const Eigen::VectorXd q = random.q(tipped), dq = random.vector(n + 6);
      const auto expect_equal = [&] {
        EXPECT_EQ(chain.pose(handle).p, tipped.pose(handle).p);
        EXPECT_EQ(chain.pose(handle).R, tipped.pose(handle).R);
        EXPECT_EQ(chain.twist(handle), tipped.twist(handle));
        EXPECT_EQ(chain.jacobian(handle), tipped.jacobian(handle).leftCols(n));
        EXPECT_EQ(chain.bias_acceleration(handle), tipped.bias_acceleration(handle));
      };
      chain.update_poses(q.head(n));
      tipped.update_poses(q);
      EXPECT_EQ(chain.pose(handle).R, tipped.pose(handle).R);
      chain.update_kinematics(q.head(n), dq.head(n));
      tipped.update_kinematics(q, dq);
      expect_equal();
      chain.update(q.head(n), dq.head(n));
      tipped.update(q, dq);
      expect_equal();
      EXPECT_LT((chain.M() - tipped.M().topLeftCorner(n, n)).norm(), 1e-6);
      EXPECT_LT((chain.c() - tipped.c().head(n)).norm(), 1e-6);
      if (HasFailure()) return;
    }
  }
}

TEST(ChainData, InverseDynamicsIsMassMatrixTimesAccelerationPlusBias) {
  for_all_chains(
      [](ChainData& chain, const auto& q, const Eigen::VectorXd& dq, RandomState& random) {
        const Eigen::VectorXd ddq = random.vector(chain.model().nv());
        chain.update(q, dq);
        const Eigen::VectorXd tau = chain.inverse_dynamics(q, dq, ddq);
        ASSERT_LT((chain.M() * ddq + chain.c() - tau).norm(), 1e-9);
        ASSERT_LT((chain.M() - chain.M().transpose()).norm(), kRounding);
        const Eigen::VectorXd zero = Eigen::VectorXd::Zero(chain.model().nv());
        ASSERT_LT((chain.inverse_dynamics(q, zero, zero) - chain.gravity()).norm(), kRounding);
      });
}

TEST(ChainData, InverseDynamicsLeavesTheResultsOfUpdateAlone) {
  for_all_chains(
      [](ChainData& chain, const auto& q, const Eigen::VectorXd& dq, RandomState& random) {
        chain.update(q, dq);
        const ChainData before(chain);
        chain.inverse_dynamics(random.q(chain), random.vector(chain.model().nv()),
                               random.vector(chain.model().nv()));
        const int handle = chain.model().frame("handle");
        ASSERT_EQ(chain.M(), before.M());
        ASSERT_EQ(chain.c(), before.c());
        ASSERT_EQ(chain.gravity(), before.gravity());
        ASSERT_EQ(chain.jacobian(handle), before.jacobian(handle));
        ASSERT_EQ(chain.bias_acceleration(handle), before.bias_acceleration(handle));
      });
}

TEST(ChainData, TorquesBalanceTheKineticEnergy) {
  // d/dt (1/2 dq^T M dq) = dq^T (tau - gravity) at constant body velocities
  for_all_chains([](ChainData& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    const auto energy_at = [&](double t) {
      chain.update(Eigen::VectorXd(chain.model().integrate(q, Eigen::VectorXd(dq * t))), dq);
      return 0.5 * dq.dot(chain.M() * dq);
    };
    const double growth = (energy_at(kStep) - energy_at(-kStep)) / (2.0 * kStep);
    chain.update(q, dq);
    const double power = dq.dot(chain.c() - chain.gravity());
    ASSERT_NEAR(power, growth, 1e-4 * (1.0 + std::abs(power)));
  });
}

TEST(ChainData, GravityIsTheSlopeOfThePotentialEnergy) {
  for_all_chains([](ChainData& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    const auto energy_at = [&](double t) {
      chain.update(Eigen::VectorXd(chain.model().integrate(q, Eigen::VectorXd(dq * t))), dq);
      return chain.potential_energy();
    };
    const double growth = (energy_at(kStep) - energy_at(-kStep)) / (2.0 * kStep);
    chain.update(q, dq);
    const double power = dq.dot(chain.gravity());
    ASSERT_NEAR(power, growth, 1e-4 * (1.0 + std::abs(power)));
  });
}

TEST(ChainData, WithoutGravityOnlyTheCoriolisPartOfTheBiasRemains) {
  ChainData with(mixed_chain({.T_B_root = slanted()}));
  ChainData without(mixed_chain({.T_B_root = slanted(), .gravity = false}));
  RandomState random(3);
  const Eigen::VectorXd q = random.q(with), dq = random.vector(with.model().nv());
  with.update(q, dq);
  without.update(q, dq);
  EXPECT_GT(with.gravity().norm(), 10.0);
  EXPECT_TRUE(without.gravity().isZero(0.0));
  EXPECT_LT((with.c() - with.gravity() - without.c()).norm(), kRounding);
  EXPECT_EQ(with.M(), without.M());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(with.model().nv());
  EXPECT_TRUE(without.inverse_dynamics(q, zero, zero).isZero(0.0));
}

TEST(ChainData, GravityPullsDownInFrameB) {
  ChainData body(ChainModel::free_body({.mass = 2.0}, {.T_B_root = slanted()}));
  body.update(body.model().neutral(), Eigen::VectorXd::Zero(6));
  const Eigen::Vector3d force = slanted().R * body.gravity().head<3>();
  EXPECT_LT((force - Eigen::Vector3d(0, 0, 2.0 * 9.81)).norm(), kRounding);
}

TEST(ChainData, AFreeBodyObeysNewtonAndEuler) {
  const Eigen::Vector3d p_com(0.1, 0.05, 0.1);
  const Eigen::Matrix3d inertia = Eigen::Vector3d(0.08, 0.1, 0.12).asDiagonal();
  ChainData body(ChainModel::free_body({.mass = 6.0, .inertia = inertia, .p_handle_com = p_com},
                                       {.T_B_root = {}, .gravity = false}));
  const Eigen::VectorXd dq{{0.3, -0.2, 0.5, 1.0, -0.7, 0.4}};
  body.update(body.model().neutral(), dq);
  const Eigen::Matrix3d S = cross_matrix(p_com);
  Eigen::Matrix<double, 6, 6> M;
  M << 6.0 * Eigen::Matrix3d::Identity(), -6.0 * S, 6.0 * S, inertia - 6.0 * S * S;
  EXPECT_LT((body.M() - M).norm(), kRounding);
  EXPECT_LT((body.jacobian(0) - Eigen::Matrix<double, 6, 6>::Identity()).norm(), kRounding);

  const Eigen::Vector3d v = dq.head<3>(), omega = dq.tail<3>();
  const Eigen::Vector3d force = 6.0 * omega.cross(v + omega.cross(p_com));
  const Eigen::Vector3d torque = p_com.cross(force) + omega.cross(inertia * omega);
  EXPECT_LT((body.c().head<3>() - force).norm(), kRounding);
  EXPECT_LT((body.c().tail<3>() - torque).norm(), kRounding);
}

TEST(ChainData, IntegrationFollowsTheExponentialOfAConstantTwist) {
  ChainData body(ChainModel::free_body({}));
  RandomState random(5);
  for (int i = 0; i < 200; ++i) {
    const Eigen::VectorXd q = random.q(body), step = random.vector(6);
    Eigen::Matrix4d twist = Eigen::Matrix4d::Zero();
    twist.topLeftCorner<3, 3>() = cross_matrix(step.tail<3>());
    twist.topRightCorner<3, 1>() = step.head<3>();
    const Eigen::Matrix4d exponential = matrix_exponential(twist);
    body.update_kinematics(q, step);
    const Pose expected =
        body.pose(0) * Pose{exponential.topRightCorner<3, 1>(), exponential.topLeftCorner<3, 3>()};
    body.update_kinematics(Eigen::VectorXd(body.model().integrate(q, step)), step);
    ASSERT_LT(distance(body.pose(0), expected), 1e-9);
  }
}

TEST(ChainData, TwoOfOneModelMoveIndependently) {
  const ChainModel model = haptic_giant_chain();
  ChainData first(model), second(model);
  RandomState random(4);
  const Eigen::VectorXd q = random.q(model), dq = random.vector(model.nv());
  const int handle = model.frame("handle");
  first.update(q, dq);
  const Pose pose = first.pose(handle);
  const Eigen::MatrixXd M = first.M();
  second.update(random.q(model), dq);
  EXPECT_EQ(first.pose(handle).p, pose.p);
  EXPECT_EQ(first.M(), M);
  EXPECT_NE(second.M(), M);
}

TEST(ChainData, KeepsItsModelAlive) {
  std::optional<ChainModel> model = haptic_giant_chain();
  ChainData before(*model), after(*model);
  RandomState random(6);
  const Eigen::VectorXd q = random.q(*model), dq = random.vector(model->nv());
  before.update(q, dq);
  model.reset();
  after.update(q, dq);
  EXPECT_EQ(after.M(), before.M());
  EXPECT_EQ(after.model().name(), "haptic_giant");
}

TEST(ChainData, CopiesAndMovesAreIndependentAndKeepTheState) {
  ChainData first(haptic_giant_chain());
  RandomState random(9);
  const Eigen::VectorXd q = random.q(first), dq = random.vector(first.model().nv());
  first.update(q, dq);
  ChainData copy(first);
  const Eigen::MatrixXd M = first.M();
  first.update(Eigen::VectorXd(2.0 * q), dq);
  EXPECT_EQ(copy.M(), M);
  EXPECT_NE(first.M(), M);
  const ChainData moved(std::move(copy));
  EXPECT_EQ(moved.M(), M);
  copy = moved;
  copy.update(q, dq);
  EXPECT_EQ(copy.M(), M);
}

TEST(ChainData, NothingAllocatesAfterConstruction) {
  for (const ChainModel& model : all_chains()) {
    ChainData chain(model);
    RandomState random(2);
    const Eigen::VectorXd q = random.q(chain), dq = random.vector(chain.model().nv());
    const ConfigurationA q_fixed = q;
    const VectorA dq_fixed = dq;
    const int handle = chain.model().frame("handle");
    double sum = 0.0;
    AllocationCounter counter;
    chain.update(q, dq);
    chain.update(q_fixed, dq_fixed);
    chain.update_kinematics(q, dq);
    chain.update_poses(q);
    sum += chain.pose(handle).p.norm() + chain.twist(handle).norm() +
           chain.jacobian(handle).norm() + chain.bias_acceleration(handle).norm();
    sum += chain.M().norm() + chain.c().norm() + chain.gravity().norm();
    sum += chain.inverse_dynamics(q, dq, dq).norm();
    sum += chain.model().integrate(q_fixed, dq_fixed).norm() + chain.model().neutral().norm();
    EXPECT_EQ(counter.count(), 0u) << chain.model().name() << sum;
  }
}

}  // namespace
}  // namespace hg::model
