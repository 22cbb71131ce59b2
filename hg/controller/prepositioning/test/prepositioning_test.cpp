#include "hg/controller/prepositioning/prepositioning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/core/error.h"
#include "hg/model/haptic_giant.h"
#include "hg/signals/drive_model.h"

namespace hg::prepositioning {
namespace {

constexpr double kDt = 1e-3;

constexpr double kGain = PrepositioningConfig{}.k_ppu;

const DeviceModel& device() {
  static const DeviceModel device = [] {
    DeviceModel model{
        .chain = model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf"),
        .n_p = 2,
        .n_m = 6};
    model.gantry_range = {Interval{-1.40, 1.40}, Interval{-1.60, 1.60}};
    return model;
  }();
  return device;
}

Prepositioning rule() { return {{}, device()}; }

// The hand is held at a fixed pose while the gantry moves below it, with the drive of `drive`.
struct HeldHand {
  DriveModel drive;
  Pose T_B_H;
  Eigen::Vector2d q{0.0, 0.0}, dq{0.0, 0.0};
  std::array<CommandDelay, 2> delay{};
  double worst_excess = 0.0;

  GantryCommand run(const DeviceModel& device, double seconds) {
    const Prepositioning gantry({}, device);
    GantryCommand command;
    for (int k = 0; k < static_cast<int>(seconds / kDt); ++k) {
      Vector6 q_m;
      EXPECT_EQ(model::haptic_giant::inverse(T_B_H, q, {}, q_m),
                model::haptic_giant::InverseStatus::kSolved);
      RobotState robot;
      robot.q_p = q;
      robot.dq_p = dq;
      command = gantry.step(robot, model::haptic_giant::gantry_target(q, q_m), false);
      for (int i = 0; i < 2; ++i) {
        const double ddq = drive_acceleration(drive, dq[i], delay[i].shift(command.dq[i], 4));
        q[i] += kDt * dq[i] + 0.5 * kDt * kDt * ddq;
        dq[i] += kDt * ddq;
        const Interval limits = device.gantry_range[i];
        worst_excess = std::max({worst_excess, q[i] - limits.ub, limits.lb - q[i]});
      }
    }
    return command;
  }
};

Pose hand_at(double x, double y) {
  Vector6 q_m;
  q_m << 0.3, 0.5 * std::numbers::pi, -std::atan2(0.53, 0.67), 1.4, 0.0, 0.0;
  Pose pose = model::haptic_giant::hand_pose({0.0, 0.0}, q_m);
  pose.p.x() = x;
  pose.p.y() = y;
  return pose;
}

TEST(Prepositioning, BringsJoints2And3ToTheirGoals) {
  HeldHand hand{.drive = {}, .T_B_H = hand_at(0.2, 0.1)};
  hand.q << 0.15, 0.05;
  hand.run(device(), 6.0);
  Vector6 q_m;
  ASSERT_EQ(model::haptic_giant::inverse(hand.T_B_H, hand.q, {}, q_m),
            model::haptic_giant::InverseStatus::kSolved);
  EXPECT_NEAR(q_m[1], 0.5 * std::numbers::pi, 1e-6);
  EXPECT_NEAR(q_m[2], -std::atan2(0.53, 0.67), 1e-6);
}

TEST(Prepositioning, StopsAtItsLimitsWhateverTheTarget) {
  DeviceModel narrow = device();
  narrow.gantry_range = {Interval{-0.05, 0.05}, Interval{-0.03, 0.03}};
  HeldHand hand{.drive = {}, .T_B_H = hand_at(0.5, -0.4)};
  const GantryCommand last = hand.run(narrow, 4.0);
  EXPECT_LE(hand.worst_excess, 1e-6);
  EXPECT_NEAR(hand.q[0], 0.05, 1e-3);
  EXPECT_NEAR(hand.q[1], -0.03, 1e-3);
  EXPECT_EQ(last.q_target[0], 0.05);
}

TEST(Prepositioning, StandsStillWhileTheDeviceIsBlocked) {
  RobotState robot;
  robot.q_p = VectorP::Zero(2);
  const VectorP target = Eigen::Vector2d(0.3, -0.2);
  EXPECT_GT(rule().step(robot, target, false).dq.norm(), 0.01);
  EXPECT_EQ(rule().step(robot, target, true).dq.norm(), 0.0);
}

TEST(Prepositioning, StopsBeforeItCarriesAFrameOverItsLimit) {
  const Prepositioning gantry = rule();
  RobotState robot;
  robot.q_p = Eigen::Vector2d(0.0, 0.0);
  const VectorP target = Eigen::Vector2d(1.0, -1.0);
  const VectorP free = gantry.step(robot, target, false).dq;
  const auto in = [&](double down, double up) {
    const Room room = {VectorP::Constant(2, down), VectorP::Constant(2, up)};
    return gantry.step(robot, target, false, kInfinity, room).dq;
  };
  EXPECT_EQ(in(kInfinity, kInfinity), free);
  EXPECT_EQ(in(10.0, 10.0), free) << "far away";
  EXPECT_EQ(in(0.1, 10.0)[0], free[0]) << "only towards a limit";
  EXPECT_EQ(in(10.0, 0.1)[1], free[1]);
  constexpr double kTakenBack = PrepositioningConfig{}.taken_back;
  for (const double left : {0.4, 0.2, 0.1}) {
    const VectorP dq = in(left, left);
    for (const double v : {dq[0] - kTakenBack, -dq[1] - kTakenBack}) {
      EXPECT_GT(v, 0.1);
      constexpr double kBraking = PrepositioningConfig{}.ddq_max;
      const double tau = device().drive.dead_time + device().drive.lag + kDt;
      EXPECT_LE(v * v / (2.0 * kBraking) + v * tau, left + 1e-12) << left;
    }
  }
  for (const double left : {0.0, -0.02}) {
    EXPECT_EQ(in(10.0, left)[0], kTakenBack) << "slowly on";
    EXPECT_EQ(in(left, 10.0)[1], -kTakenBack);
  }
}

TEST(Prepositioning, StopsWithinItsRoomWhereTheArmTakesNothingBack) {
  const Prepositioning gantry({.taken_back = 0.0}, device());
  RobotState robot;
  robot.q_p = Eigen::Vector2d(0.0, 0.0);
  const VectorP target = Eigen::Vector2d(1.0, -1.0);
  for (const double left : {0.4, 0.1, 0.0, -0.02}) {
    const Room room = {VectorP::Constant(2, 10.0), VectorP::Constant(2, left)};
    const double v = gantry.step(robot, target, false, kInfinity, room).dq[0];
    constexpr double kBraking = PrepositioningConfig{}.ddq_max;
    const double tau = device().drive.dead_time + device().drive.lag + kDt;
    EXPECT_GE(v, 0.0) << left;
    EXPECT_LE(v * v / (2.0 * kBraking) + v * tau, std::max(left, 0.0) + 1e-12) << left;
  }
}

// What the law leaves at its aim is what the rule commands.
TEST(Prepositioning, TheAimOfTheLawIsTheRule) {
  const Prepositioning gantry = rule();
  RobotState robot;
  robot.q_p = Eigen::Vector2d(0.1, -0.2);
  robot.dq_p = Eigen::Vector2d(0.03, -0.02);
  robot.ddq_p = Eigen::Vector2d(0.5, 0.2);
  const GantryCommand command = gantry.step(robot, Eigen::Vector2d(0.12, -0.21), false);
  const GantryTask task = gantry.accelerations(command, robot, VectorP(0));
  const VectorP dq = gantry.velocity_for(task.ddq, command, robot);
  EXPECT_LT((dq - command.dq).cwiseAbs().maxCoeff(), 1e-12);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(task.ddq_max[i] - task.ddq_min[i], 2.0 * device().drive.ddq_max / 60.0, 1e-12);
    EXPECT_NEAR(task.ddq_max[i] + task.ddq_min[i], 2.0 * robot.ddq_p[i], 1e-12);
  }
}

// A gantry whose drives follow their model, led by the law.
struct LedGantry {
  Prepositioning rule = prepositioning::rule();
  DriveModel drive = device().drive;
  RobotState robot;
  std::array<CommandDelay, 2> delay{};
  VectorP last;

  LedGantry() { robot.q_p = robot.dq_p = robot.ddq_p = Eigen::Vector2d::Zero(); }

  // for one period, towards `q_target`; `choose` is the law
  void step(const VectorP& q_target, const auto& choose) {
    const GantryCommand command = rule.step(robot, q_target, false);
    last = choose(rule.accelerations(command, robot, last));
    const VectorP dq = rule.velocity_for(last, command, robot);
    for (int i = 0; i < 2; ++i) {
      const double arrived = delay[i].shift(dq[i], 4);
      robot.ddq_p[i] = drive_acceleration(drive, robot.dq_p[i], arrived);
      robot.q_p[i] += kDt * robot.dq_p[i] + 0.5 * kDt * kDt * robot.ddq_p[i];
      robot.dq_p[i] += kDt * robot.ddq_p[i];
    }
  }
};

TEST(Prepositioning, TheDrivesFollowTheLaw) {
  const VectorP wanted = Eigen::Vector2d(1.0, -1.5);
  LedGantry gantry;
  for (int k = 0; k < 300; ++k) {
    // the rule goes along, so that nothing but its drives limits the gantry
    const VectorP target = gantry.robot.q_p + gantry.robot.dq_p / kGain;
    gantry.step(target, [&](const GantryTask& task) -> VectorP {
      return wanted.cwiseMax(task.ddq_min).cwiseMin(task.ddq_max);
    });
    if (k > 70) {
      EXPECT_LT((gantry.robot.ddq_p - wanted).cwiseAbs().maxCoeff(), 0.03) << k;
    }
  }
}

// However much the law wants, it leads 0.1 m/s beside the rule and nowhere beyond the range.
TEST(Prepositioning, TheLawLeadsTheGantryNotFar) {
  const auto most = [](const GantryTask& task) { return task.ddq_max; };
  LedGantry gantry;
  for (int k = 0; k < 3000; ++k) gantry.step(Eigen::Vector2d(0.3, 0.2), most);
  EXPECT_NEAR(gantry.robot.q_p[0], 0.3 + 0.1 / kGain, 1e-3);
  for (int k = 0; k < 6000; ++k) {
    gantry.step(Eigen::Vector2d(3.0, 3.0), most);
    for (int i = 0; i < 2; ++i) {
      EXPECT_LT(gantry.robot.q_p[i], device().gantry_range[i].ub + 1e-3) << k;
    }
  }
  EXPECT_NEAR(gantry.robot.q_p[0], 1.40, 5e-3);
}

TEST(Prepositioning, RefusesImpossibleConfigurations) {
  EXPECT_THROW(Prepositioning({.k_ppu = 0.0}, device()), SetupError);
  EXPECT_THROW(Prepositioning({.dq_max = 0.0}, device()), SetupError);
  EXPECT_THROW(Prepositioning({.ddq_max = -1.0}, device()), SetupError);
}

}  // namespace
}  // namespace hg::prepositioning
