// The URDFs in models/: geometry, masses and placements that models/README.md promises.

#include <gtest/gtest.h>

#include <string>

#include "hg/model/chain_data.h"
#include "hg/model/haptic_giant.h"
#include "hg/model/test/dh_reference.h"
#include "hg/model/test/models.h"

namespace hg::model {
namespace {

using std::numbers::pi;

using Vector8 = Eigen::Matrix<double, 8, 1>;
constexpr double kRounding = 1e-12;
constexpr double kPrinted = 5.001e-6;  // half of the last digit printed by the reference

// working set of the mass model, from an independent Newton-Euler implementation
const Vector8 kQ{{0.3, -0.2, 0.4, 1.2, -0.5, 1.1, 0.3, -0.7}};
const Vector8 kDq{{0.2, -0.1, 0.5, -0.6, 0.7, 0.8, -0.9, 1.0}};
const Vector8 kDdq{{0.1, 0.2, -0.3, 0.4, -0.5, 0.6, -0.7, 0.8}};

void expect_printed(const Eigen::VectorXd& value, const Eigen::VectorXd& expected) {
  EXPECT_LT((value - expected).cwiseAbs().maxCoeff(), kPrinted) << value.transpose();
}

TEST(HapticGiantUrdf, PosesEqualTableI) {
  ChainData chain(haptic_giant_chain());
  const int handle = chain.model().frame("handle"), elbow = chain.model().frame("elbow");
  RandomState random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector8 q = 1.5 * random.vector(8);
    chain.update_kinematics(q, Vector8::Zero());
    const DhFrames expected = dh_frames(q);
    ASSERT_LT(distance(chain.pose(handle), expected.hand), kRounding) << q.transpose();
    ASSERT_LT(distance(chain.pose(elbow), expected.elbow), kRounding) << q.transpose();
    ASSERT_TRUE(chain.jacobian(elbow).rightCols<3>().isZero(0.0));
  }
}

TEST(HapticGiantUrdf, DynamicsEqualTheReference) {
  ChainData chain(haptic_giant_chain());
  chain.update(kQ, kDq);
  const Eigen::VectorXd tau = chain.inverse_dynamics(kQ, kDq, kDdq);
  expect_printed(
      tau, Vector8{{23.24069, 14.2393, 0.24974, -0.38784, -0.02738, 28.11989, 2.15888, 0.00097}});
  expect_printed(chain.c(), Vector8{{-1.69521, -0.04121, 0.74515, 0.41539, 0.24465, 27.51581,
                                     2.11219, -0.00007}});
  expect_printed(chain.gravity(), Vector8{{0, 0, 0, 0, 0, 27.53918, 2.0978, 0}});
  const Vector6 w_H_in_B{{10, -20, 30, 1, 2, -3}};
  expect_printed(
      tau - chain.jacobian(chain.model().frame("handle")).transpose() * w_H_in_B,
      Vector8{{13.24069, 34.2393, 12.52455, 0.05981, -5.8856, 10.52451, -1.67575, 1.69455}});
}

TEST(HapticGiantUrdf, MassMatrixAtHomeEqualsTheReference) {
  ChainData chain(haptic_giant_chain());
  const Vector8 home{{0, 0, 0, pi / 2, -std::atan2(0.53, 0.67), pi / 2, 0, 0}};
  chain.update(home, Vector8::Zero());
  const Eigen::MatrixXd M = chain.M().bottomRightCorner<6, 6>();
  expect_printed(M.diagonal(), Vector6{{14.02036, 7.07472, 1.36439, 1.34439, 0.02271, 0.0012}});
  EXPECT_NEAR(M(0, 1), 6.04652, kPrinted);
  EXPECT_NEAR(M(0, 2), -1.30695, kPrinted);
  EXPECT_NEAR(M(3, 4), 0.11385, kPrinted);
  expect_printed(chain.gravity(), Vector8{{0, 0, 0, 0, 0, 30.67587, 2.12877, 0}});
  EXPECT_NEAR(chain.M()(1, 1), 36.8 + 60.0, kRounding);
  EXPECT_NEAR(chain.M()(0, 0), 36.8 + 60.0 + 160.0, kRounding);
}

TEST(HapticGiantUrdf, JointOneTurnsWithoutEndAndTheOthersHaveLimits) {
  const ChainModel chain = haptic_giant_chain();
  EXPECT_EQ(chain.joints()[chain.joint("m1")].type, JointType::kContinuous);
  const auto limit = [&](const char* name) { return chain.joints()[chain.joint(name)].position; };
  EXPECT_EQ(limit("m2").lb, limit("m4").lb);
  EXPECT_EQ(limit("m5").ub, limit("m6").ub);
  EXPECT_GT(limit("m2").lb, 0.0);
  for (const char* name : {"ppu1", "ppu2", "m2", "m3", "m4", "m5", "m6"}) {
    EXPECT_GT(limit(name).lb, -kInfinity) << name;
    EXPECT_LT(limit(name).ub, kInfinity) << name;
  }
}

TEST(FreeSpaceUrdf, IsTheDefaultFreeBody) {
  ChainData urdf(twin_chain("free_space"));
  ChainData body(ChainModel::free_body({}));
  RandomState random(4);
  const Eigen::VectorXd q = random.q(body), dq = random.vector(6);
  urdf.update(q, dq);
  body.update(q, dq);
  EXPECT_LT((urdf.M() - body.M()).norm(), kRounding);
  EXPECT_LT((urdf.c() - body.c()).norm(), 1e-11);
  EXPECT_LT(distance(urdf.pose(urdf.model().frame("handle")), body.pose(0)), kRounding);
  EXPECT_EQ(urdf.model().joints()[0].name, body.model().joints()[0].name);
}

TEST(ChainUrdfs, AreLongAndHeavyAsTheirReadmeSays) {
  for (const int joints : {20, 30}) {
    SCOPED_TRACE(joints);
    ChainData chain(twin_chain("chain_" + std::to_string(joints)));
    ASSERT_EQ(chain.model().nv(), joints);
    const VectorA straight = VectorA::Zero(joints);
    chain.update(straight, straight);
    const Eigen::Vector3d tip = chain.pose(chain.model().frame("handle")).p;
    EXPECT_LT((tip - Eigen::Vector3d(1.2, 0.0, 0.0)).norm(), kRounding);
    // the weight of all links, half a length from j2 on: 10 kg in all
    EXPECT_NEAR(chain.gravity()[1] / -9.81 / (0.5 * (1.2 - 1.2 / joints)),
                10.0 * (joints - 1) / joints, 2e-3);
    for (int i = 0; i < joints; ++i) {
      const Interval range = chain.model().joints()[i].position;
      EXPECT_NEAR(range.ub - range.lb, 2.0 / joints, 1e-3) << i;
    }
  }
}

TEST(DoorUrdf, MassMatrixIsConstantAndUncoupled) {
  ChainData door(twin_chain("door"));
  Eigen::Matrix2d M;
  M << 2.5, 0.0, 0.0, 0.02;
  for (const double hinge : {0.0, 0.6, 1.75}) {
    for (const double lever : {0.0, 0.4, 0.8}) {
      door.update(Eigen::Vector2d(hinge, lever), Eigen::Vector2d(0.5, -2.0));
      EXPECT_LT((door.M() - M).norm(), 1e-4) << hinge << " " << lever;
      EXPECT_LT(door.c().norm(), 1e-11);
    }
  }
}

TEST(DoorUrdf, HandIsAtThreeQuartersOfAMetreAndMovesDownWithTheLever) {
  ChainData door(twin_chain("door"));
  const int handle = door.model().frame("handle");
  door.update_kinematics(Eigen::Vector2d(0, 0), Eigen::Vector2d(0, 0));
  const Jacobian J = door.jacobian(handle);
  EXPECT_LT((J.col(0) - Vector6{{0.06, 0.75, 0, 0, 0, 1}}).norm(), kRounding);
  EXPECT_LT((J.col(1) - Vector6{{0, 0, -0.11, 0, -1, 0}}).norm(), kRounding);
  Eigen::Matrix3d R;
  R << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  EXPECT_LT((door.pose(handle).R - R).norm(), kRounding);
}

TEST(ExcavatorUrdf, TipFollowsTheThreePitches) {
  ChainData excavator(twin_chain("excavator"));
  const int handle = excavator.model().frame("handle");
  RandomState random(6);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector4d q = random.vector(4);
    excavator.update_kinematics(q, Eigen::Vector4d::Zero());
    const double a1 = q[1], a2 = a1 - q[2], a3 = a2 - q[3];
    const double r = 0.15 + 0.90 * std::cos(a1) + 0.70 * std::cos(a2) + 0.35 * std::cos(a3);
    const double z = 0.90 * std::sin(a1) + 0.70 * std::sin(a2) + 0.35 * std::sin(a3);
    const Eigen::Vector3d tip(r * std::cos(q[0]), r * std::sin(q[0]), z);
    ASSERT_LT((excavator.pose(handle).p - tip).norm(), kRounding);
  }
}

TEST(ExcavatorUrdf, MassesActInTheMiddleOfRods) {
  // inertia of boom, stick, bucket about the boom's axis in the extended posture
  ChainData excavator(twin_chain("excavator"));
  excavator.update(Eigen::Vector4d::Zero(), Eigen::Vector4d::Zero());
  const double bucket = 4.0 * (0.35 * 0.35 / 12.0 + 0.175 * 0.175) + 0.05;
  const double stick = 8.0 * (0.7 * 0.7 / 12.0 + 0.35 * 0.35) + 4.0 * (0.35 * 0.35 / 12.0) + 0.05 +
                       4.0 * 0.875 * 0.875;
  EXPECT_NEAR(excavator.M()(3, 3), bucket, 1e-4);
  EXPECT_NEAR(excavator.M()(2, 2), stick, 1e-4);
  EXPECT_NEAR(excavator.M()(1, 2), -stick - 0.9 * (8.0 * 0.35 + 4.0 * 0.875), 1e-4);
}

struct Placement {
  const char* twin;
  Pose T_B_root;
};

// models/README.md
const Placement kDoor = {"door", {{-0.30, -0.20, -0.80}, Eigen::Matrix3d::Identity()}};
const Placement kExcavator = {
    "excavator",
    {{-1.00, -0.80, -0.42},
     Eigen::AngleAxisd(pi / 6, Eigen::Vector3d::UnitZ()).toRotationMatrix()}};

// smallest distances to the limits of the device, with the gantry at its target
struct Margins {
  double cartesian = 10.0;  // m, hand and elbow, horizontal
  double gantry = 10.0;     // m
  double joints = 10.0;     // rad, m4..m6 and q4+q5
  double s_lowest = 10.0, s_highest = -10.0;
};

void add_margins(ChainData& twin, const Eigen::VectorXd& q, Margins& margins) {
  static const ChainModel device = haptic_giant_chain();
  const auto room = [](double x, double lower, double upper) {
    return std::min(x - lower, upper - x);
  };
  twin.update_kinematics(q, Eigen::VectorXd::Zero(twin.model().nv()));
  const Pose hand = twin.pose(twin.model().frame("handle"));
  Eigen::Vector2d q_p;
  Vector6 q_m;
  ASSERT_EQ(haptic_giant::inverse_at_target(hand, q_p, q_m), haptic_giant::InverseStatus::kSolved);
  const Eigen::Vector3d elbow = haptic_giant::elbow(q_p, q_m);
  for (const Eigen::Vector3d& p : {hand.p, elbow}) {
    margins.cartesian =
        std::min({margins.cartesian, room(p.x(), -1.65, 1.65), room(p.y(), -1.95, 1.95)});
  }
  for (int i = 0; i < 8; ++i) {
    const Joint& joint = device.joints()[i];
    const double q_i = i < 2 ? q_p[i] : q_m[i - 2];
    double& margin = i < 2 ? margins.gantry : margins.joints;
    margin = std::min(margin, room(q_i, joint.position.lb, joint.position.ub));
  }
  const double s = q_m[3] + q_m[4];
  margins.joints = std::min(margins.joints, room(s, 0.26, 2.88));
  margins.s_lowest = std::min(margins.s_lowest, s);
  margins.s_highest = std::max(margins.s_highest, s);
}

TEST(Placements, TheDoorStaysInsideAllLimitsOverItsWholeTravel) {
  ChainData door(twin_chain(kDoor.twin, {.T_B_root = kDoor.T_B_root}));
  Margins margins;
  for (double hinge = 0.0; hinge < 1.76; hinge += 0.05) {
    for (double lever = 0.0; lever < 0.81; lever += 0.1) {
      add_margins(door, Eigen::Vector2d(hinge, lever), margins);
    }
  }
  EXPECT_GT(margins.cartesian, 0.70);
  EXPECT_GT(margins.gantry, 0.70);
  EXPECT_GT(margins.joints, 0.99);
  EXPECT_NEAR(margins.s_lowest, pi / 2, 1e-9);
  EXPECT_NEAR(margins.s_highest, pi / 2, 1e-9);
}

// calls `visit` on a grid over the limits of the excavator
template <typename Visit>
void for_all_postures(Visit visit) {
  for (double swing = -0.9; swing < 0.91; swing += 0.15) {
    for (double boom = 0.0; boom < 0.96; boom += 0.095) {
      for (double stick = 0.0; stick < 2.01; stick += 0.1) {
        for (double bucket = 0.0; bucket < 1.01; bucket += 0.1) {
          visit(Eigen::Vector4d(swing, boom, stick, bucket));
        }
      }
    }
  }
}

TEST(Placements, TheHandAxisOfTheExcavatorStays45DegreesFromTheVertical) {
  ChainData excavator(twin_chain(kExcavator.twin, {.T_B_root = kExcavator.T_B_root}));
  const int handle = excavator.model().frame("handle");
  for_all_postures([&](const Eigen::Vector4d& q) {
    excavator.update_kinematics(q, Eigen::Vector4d::Zero());
    ASSERT_LT(std::abs(excavator.pose(handle).R(2, 2)), std::sqrt(0.5) + 1e-9);
  });
}

TEST(Placements, TheExcavatorStaysInsideAllLimitsWithItsTipAtMiddleHeight) {
  ChainData excavator(twin_chain(kExcavator.twin, {.T_B_root = kExcavator.T_B_root}));
  const int handle = excavator.model().frame("handle");
  Margins margins;
  int inside = 0;
  for_all_postures([&](const Eigen::Vector4d& q) {
    excavator.update_kinematics(q, Eigen::Vector4d::Zero());
    const double height = excavator.pose(handle).p.z();
    if (height < -1.00 || height > -0.55) return;
    ++inside;
    add_margins(excavator, q, margins);
  });
  EXPECT_GT(inside, 5000);
  EXPECT_GT(margins.cartesian, 0.05);
  EXPECT_GT(margins.gantry, 0.05);
  EXPECT_GT(margins.joints, 0.15);
}

TEST(Placements, TheExcavatorReachesEveryPostureOfItsScenario) {
  ChainData excavator(twin_chain(kExcavator.twin, {.T_B_root = kExcavator.T_B_root}));
  Margins margins;
  for (const Eigen::Vector4d& q :
       {Eigen::Vector4d(0, 0.35, 0.9, 0.4), Eigen::Vector4d(0, 0, 0.4, 0.0),
        Eigen::Vector4d(0, 0.02, 0.71, 1.0), Eigen::Vector4d(0, 0.03, 0.01, 0.03),
        Eigen::Vector4d(-0.9, 0.49, 1.0, 0.45), Eigen::Vector4d(0.9, 0.43, 0.8, 0.84),
        Eigen::Vector4d(0, 0.27, 0.87, 1.0), Eigen::Vector4d(0.6, 0.8, 1.65, 0.0)}) {
    add_margins(excavator, q, margins);
  }
  EXPECT_GT(margins.cartesian, 0.25);
  EXPECT_GT(margins.gantry, 0.15);
  EXPECT_GT(margins.joints, 0.05);
}

}  // namespace
}  // namespace hg::model
