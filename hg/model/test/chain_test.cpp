#include "hg/model/chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
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
  for (Chain& chain : all_chains()) {
    for (unsigned seed = 0; seed < kSamples; ++seed) {
      SCOPED_TRACE(chain.name() + ", seed " + std::to_string(seed));
      RandomState random(seed);
      const Eigen::VectorXd q = random.q(chain);
      law(chain, q, random.vector(chain.nv()), random);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(Chain, JointsAreListedWithTheirPlacesInQAndDq) {
  const Chain chain = mixed_chain();
  ASSERT_EQ(chain.joints().size(), 4u);
  EXPECT_EQ(chain.nq(), 10);
  EXPECT_EQ(chain.nv(), 9);
  const Joint& free = chain.joints()[2];
  EXPECT_EQ(free.name, "free");
  EXPECT_EQ(free.type, JointType::kFloating);
  EXPECT_EQ(free.q_index, 2);
  EXPECT_EQ(free.v_index, 2);
  EXPECT_EQ(free.nq, 7);
  EXPECT_EQ(free.nv, 6);
  EXPECT_FALSE(free.position.bounded());
  const Joint& spin = chain.joints()[3];
  EXPECT_EQ(spin.type, JointType::kContinuous);
  EXPECT_EQ(spin.q_index, 9);
  EXPECT_EQ(spin.v_index, 8);
  EXPECT_EQ(spin.nq, 1);
  EXPECT_EQ(chain.joint("spin"), 3);
}

TEST(Chain, AFloatingRootIsTheFirstJointAndStartsAtItsPlacement) {
  Chain chain = all_chains().back();
  chain.update_kinematics(chain.neutral(), Eigen::VectorXd::Zero(7));
  EXPECT_LT(distance(chain.pose(chain.frame("body")), slanted()), kRounding);
  EXPECT_EQ(chain.joints()[0].name, "root");
  EXPECT_EQ(chain.joints()[0].type, JointType::kFloating);
  EXPECT_EQ(chain.nv(), 7);
}

TEST(Chain, AFloatingRootWithoutMassIsRefused) {
  EXPECT_THROW(haptic_giant_chain({.T_B_root = {}, .floating_root = true}), SetupError);
}

TEST(Chain, WrongNamesAreAnsweredWithTheNearest) {
  const Chain chain = haptic_giant_chain();
  const auto message_of = [](auto call) -> std::string {
    try {
      call();
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message_of([&] { (void)chain.frame("hand"); }),
            "haptic_giant: frame must be one of the chain, got 'hand', nearest is 'handle'");
  EXPECT_EQ(message_of([&] { (void)chain.joint("M7"); }),
            "haptic_giant: joint must be one of the chain, got 'M7', nearest is 'm1'");
}

TEST(Chain, TheRootStandsAtItsPlacement) {
  Chain chain = mixed_chain({.T_B_root = slanted()});
  Chain at_origin = mixed_chain();
  const Eigen::VectorXd q = RandomState(1).q(chain);
  const Eigen::VectorXd dq = Eigen::VectorXd::Zero(chain.nv());
  chain.update_kinematics(q, dq);
  at_origin.update_kinematics(q, dq);
  EXPECT_LT(distance(chain.pose(chain.frame("base")), slanted()), kRounding);
  for (int i = 0; i < static_cast<int>(chain.frame_names().size()); ++i) {
    EXPECT_LT(distance(chain.pose(i), slanted() * at_origin.pose(i)), kRounding);
  }
  EXPECT_TRUE(chain.jacobian(chain.frame("base")).isZero(0.0));
  EXPECT_TRUE(chain.twist(chain.frame("base")).isZero(0.0));
}

TEST(Chain, FixedLinksAndJointsFollowTheUrdf) {
  // by hand, along the first two joints of mixed_chain()
  Chain chain = mixed_chain();
  Eigen::VectorXd q = chain.neutral();
  q[0] = 0.8;
  q[1] = -0.3;
  chain.update_kinematics(q, Eigen::VectorXd::Zero(chain.nv()));
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
  EXPECT_LT(distance(chain.pose(chain.frame("a")), turned), kRounding);
  EXPECT_LT(distance(chain.pose(chain.frame("a_tool")), tool), kRounding);
  EXPECT_LT(distance(chain.pose(chain.frame("b")), slid), kRounding);
}

TEST(Chain, LinksOnFixedJointsAddTheirMassWhereTheyAre) {
  constexpr std::string_view kText = R"(<robot name="flail"><link name="base"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
  </joint>
  <link name="arm"><inertial><mass value="1"/>
    <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="weld" type="fixed"><parent link="arm"/><child link="ball"/>
    <origin xyz="0.5 0 0" rpy="1.5707963267948966 0 0"/></joint>
  <link name="ball"><inertial><origin xyz="0 0 0.3"/><mass value="2"/>
    <inertia ixx="0.1" iyy="0.2" izz="0.15" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)";
  Chain chain = Chain::from_urdf_text(kText, "flail.urdf");
  chain.update(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1));
  EXPECT_NEAR(chain.M()(0, 0), 1.0 + 0.2 + 2.0 * (0.5 * 0.5 + 0.3 * 0.3), kRounding);
}

TEST(Chain, JacobianAndTwistAreTheDerivativeOfThePose) {
  for_all_chains([](Chain& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    for (int frame = 0; frame < static_cast<int>(chain.frame_names().size()); ++frame) {
      const auto pose_at = [&](double t) {
        chain.update_kinematics(Eigen::VectorXd(chain.integrate(q, Eigen::VectorXd(dq * t))), dq);
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

TEST(Chain, BiasAccelerationIsTheDerivativeOfTheJacobianTimesTheVelocity) {
  for_all_chains([](Chain& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    for (int frame = 0; frame < static_cast<int>(chain.frame_names().size()); ++frame) {
      const auto velocity_at = [&](double t) -> Vector6 {
        chain.update_kinematics(Eigen::VectorXd(chain.integrate(q, Eigen::VectorXd(dq * t))), dq);
        return chain.jacobian(frame) * dq;
      };
      const Vector6 expected = (velocity_at(kStep) - velocity_at(-kStep)) / (2.0 * kStep);
      chain.update_kinematics(q, dq);
      ASSERT_LT((chain.bias_acceleration(frame) - expected).cwiseAbs().maxCoeff(), kDifference);
    }
  });
}

TEST(Chain, UpdateContainsTheKinematics) {
  for_all_chains([](Chain& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    Chain other = chain;
    chain.update(q, dq);
    other.update_kinematics(q, dq);
    for (int frame = 0; frame < static_cast<int>(chain.frame_names().size()); ++frame) {
      ASSERT_LT(distance(chain.pose(frame), other.pose(frame)), kRounding);
      ASSERT_LT((chain.twist(frame) - other.twist(frame)).norm(), kRounding);
      ASSERT_LT((chain.jacobian(frame) - other.jacobian(frame)).norm(), kRounding);
      ASSERT_LT((chain.bias_acceleration(frame) - other.bias_acceleration(frame)).norm(),
                kRounding);
    }
  });
}

TEST(Chain, PosesAloneAreThoseOfTheKinematicsToTheBit) {
  for_all_chains([](Chain& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    Chain other = chain;
    chain.update_poses(q);
    other.update_kinematics(q, dq);
    for (int frame = 0; frame < static_cast<int>(chain.frame_names().size()); ++frame) {
      ASSERT_EQ(chain.pose(frame).p, other.pose(frame).p);
      ASSERT_EQ(chain.pose(frame).R, other.pose(frame).R);
    }
  });
}

// Chains with a floating joint are computed by the library, all others by passes of their own.
TEST(Chain, AFloatingJointAtTheTipChangesNoBitOfWhatIsBeforeIt) {
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
    Chain chain = Chain::from_urdf_text(text, "chain.urdf", options);
    Chain tipped = Chain::from_urdf_text(text.replace(text.rfind("</robot>"), 8, kTip),
                                         "tipped.urdf", options);
    const int n = chain.nv(), handle = chain.frame("handle");
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

TEST(Chain, InverseDynamicsIsMassMatrixTimesAccelerationPlusBias) {
  for_all_chains([](Chain& chain, const auto& q, const Eigen::VectorXd& dq, RandomState& random) {
    const Eigen::VectorXd ddq = random.vector(chain.nv());
    chain.update(q, dq);
    const Eigen::VectorXd tau = chain.inverse_dynamics(q, dq, ddq);
    ASSERT_LT((chain.M() * ddq + chain.c() - tau).norm(), 1e-9);
    ASSERT_LT((chain.M() - chain.M().transpose()).norm(), kRounding);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(chain.nv());
    ASSERT_LT((chain.inverse_dynamics(q, zero, zero) - chain.gravity()).norm(), kRounding);
  });
}

TEST(Chain, InverseDynamicsLeavesTheResultsOfUpdateAlone) {
  for_all_chains([](Chain& chain, const auto& q, const Eigen::VectorXd& dq, RandomState& random) {
    chain.update(q, dq);
    const Chain before = chain;
    chain.inverse_dynamics(random.q(chain), random.vector(chain.nv()), random.vector(chain.nv()));
    const int handle = chain.frame("handle");
    ASSERT_EQ(chain.M(), before.M());
    ASSERT_EQ(chain.c(), before.c());
    ASSERT_EQ(chain.gravity(), before.gravity());
    ASSERT_EQ(chain.jacobian(handle), before.jacobian(handle));
    ASSERT_EQ(chain.bias_acceleration(handle), before.bias_acceleration(handle));
  });
}

TEST(Chain, TorquesBalanceTheKineticEnergy) {
  // d/dt (1/2 dq^T M dq) = dq^T (tau - gravity) at constant body velocities
  for_all_chains([](Chain& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    const auto energy_at = [&](double t) {
      chain.update(Eigen::VectorXd(chain.integrate(q, Eigen::VectorXd(dq * t))), dq);
      return 0.5 * dq.dot(chain.M() * dq);
    };
    const double growth = (energy_at(kStep) - energy_at(-kStep)) / (2.0 * kStep);
    chain.update(q, dq);
    const double power = dq.dot(chain.c() - chain.gravity());
    ASSERT_NEAR(power, growth, 1e-4 * (1.0 + std::abs(power)));
  });
}

TEST(Chain, GravityIsTheSlopeOfThePotentialEnergy) {
  for_all_chains([](Chain& chain, const auto& q, const Eigen::VectorXd& dq, RandomState&) {
    const auto energy_at = [&](double t) {
      chain.update(Eigen::VectorXd(chain.integrate(q, Eigen::VectorXd(dq * t))), dq);
      return chain.potential_energy();
    };
    const double growth = (energy_at(kStep) - energy_at(-kStep)) / (2.0 * kStep);
    chain.update(q, dq);
    const double power = dq.dot(chain.gravity());
    ASSERT_NEAR(power, growth, 1e-4 * (1.0 + std::abs(power)));
  });
}

TEST(Chain, WithoutGravityOnlyTheCoriolisPartOfTheBiasRemains) {
  Chain with = mixed_chain({.T_B_root = slanted()});
  Chain without = mixed_chain({.T_B_root = slanted(), .gravity = false});
  RandomState random(3);
  const Eigen::VectorXd q = random.q(with), dq = random.vector(with.nv());
  with.update(q, dq);
  without.update(q, dq);
  EXPECT_GT(with.gravity().norm(), 10.0);
  EXPECT_TRUE(without.gravity().isZero(0.0));
  EXPECT_LT((with.c() - with.gravity() - without.c()).norm(), kRounding);
  EXPECT_EQ(with.M(), without.M());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(with.nv());
  EXPECT_TRUE(without.inverse_dynamics(q, zero, zero).isZero(0.0));
}

TEST(Chain, GravityPullsDownInFrameB) {
  Chain body = Chain::free_body({.mass = 2.0}, {.T_B_root = slanted()});
  body.update(body.neutral(), Eigen::VectorXd::Zero(6));
  const Eigen::Vector3d force = slanted().R * body.gravity().head<3>();
  EXPECT_LT((force - Eigen::Vector3d(0, 0, 2.0 * 9.81)).norm(), kRounding);
}

TEST(Chain, AFreeBodyObeysNewtonAndEuler) {
  const Eigen::Vector3d p_com(0.1, 0.05, 0.1);
  const Eigen::Matrix3d inertia = Eigen::Vector3d(0.08, 0.1, 0.12).asDiagonal();
  Chain body = Chain::free_body({.mass = 6.0, .inertia = inertia, .p_handle_com = p_com},
                                {.T_B_root = {}, .gravity = false});
  const Eigen::VectorXd dq{{0.3, -0.2, 0.5, 1.0, -0.7, 0.4}};
  body.update(body.neutral(), dq);
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

TEST(Chain, AnImpossibleFreeBodyIsRefused) {
  EXPECT_THROW(Chain::free_body({.mass = 0.0}), SetupError);
  EXPECT_THROW(Chain::free_body({.inertia = Eigen::Vector3d(1, 1, 3).asDiagonal()}), SetupError);
  EXPECT_THROW(Chain::free_body({.p_handle_com = Eigen::Vector3d(0, std::nan(""), 0)}), SetupError);
}

TEST(Chain, IntegrationFollowsTheExponentialOfAConstantTwist) {
  Chain body = Chain::free_body({});
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
    body.update_kinematics(Eigen::VectorXd(body.integrate(q, step)), step);
    ASSERT_LT(distance(body.pose(0), expected), 1e-9);
  }
}

TEST(Chain, IntegrationIsExactForTinySteps) {
  Chain body = Chain::free_body({});
  const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd{{1.0, -2.0, 3.0, -4.0, 5.0, 6.0}};
  const ConfigurationA q = body.integrate(body.neutral(), step);
  const double half = 0.5 * step.tail<3>().norm();
  const Eigen::Vector3d axis_part = std::sin(half) * step.tail<3>().normalized();
  EXPECT_LT((q.segment<3>(3) - axis_part).norm(), 1e-19);
  EXPECT_LT((q.head<3>() - step.head<3>()).norm(), 2e-9);
}

TEST(Chain, IntegrationKeepsQuaternionsNormalisedOverAMillionSteps) {
  Chain body = Chain::free_body({});
  ConfigurationA q = body.neutral();
  const Eigen::VectorXd step{{0.0, 0.0, 0.0, 2e-3, -1e-3, 3e-3}};
  for (int i = 0; i < 1'000'000; ++i) q = body.integrate(q, step);
  EXPECT_NEAR(q.tail<4>().norm(), 1.0, 1e-12);
  const double angle = std::remainder(1e6 * step.norm(), 2.0 * std::numbers::pi);
  EXPECT_NEAR(std::abs(q[6]), std::abs(std::cos(0.5 * angle)), 1e-6);
}

TEST(Chain, IntegrationAddsScalarCoordinatesWithoutWrapping) {
  const Chain chain = haptic_giant_chain();
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(8, -20.0, 20.0);
  const Eigen::VectorXd step = Eigen::VectorXd::LinSpaced(8, 5.0, 7.0);
  EXPECT_LT((chain.integrate(q, step) - (q + step)).norm(), 1e-14);
}

TEST(Chain, CopiesAndMovesAreIndependentAndKeepTheState) {
  Chain first = haptic_giant_chain();
  RandomState random(9);
  const Eigen::VectorXd q = random.q(first), dq = random.vector(first.nv());
  first.update(q, dq);
  Chain copy = first;
  const Eigen::MatrixXd M = first.M();
  first.update(Eigen::VectorXd(2.0 * q), dq);
  EXPECT_EQ(copy.M(), M);
  EXPECT_NE(first.M(), M);
  const Chain moved = std::move(copy);
  EXPECT_EQ(moved.M(), M);
  copy = moved;
  copy.update(q, dq);
  EXPECT_EQ(copy.M(), M);
}

TEST(Chain, NothingAllocatesAfterConstruction) {
  for (Chain& chain : all_chains()) {
    RandomState random(2);
    const Eigen::VectorXd q = random.q(chain), dq = random.vector(chain.nv());
    const ConfigurationA q_fixed = q;
    const VectorA dq_fixed = dq;
    const int handle = chain.frame("handle");
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
    sum += chain.integrate(q_fixed, dq_fixed).norm() + chain.neutral().norm();
    EXPECT_EQ(counter.count(), 0u) << chain.name() << sum;
  }
}

}  // namespace
}  // namespace hg::model
