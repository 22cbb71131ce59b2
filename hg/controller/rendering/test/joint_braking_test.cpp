// Limits that brake together.

#include "hg/controller/rendering/joint_braking.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "hg/controller/rendering/test/playing.h"
#include "hg/signals/test/reference_actuators.h"

namespace hg::rendering {
namespace {

constexpr limits::JointLimits kJoint = {.q_min = -1.0, .q_max = 0.5, .dq_max = 2.0, .ddq_max = 6.0};
const limits::RecoverableOptions kOptions = [] {
  limits::RecoverableOptions options = limits::recoverable_options(kJoint, kDt, kDt);
  options.is_capped = false;
  options.tau_onset = 25e-3;
  return options;
}();

TEST(Approach, NeedsWhatStopsItInFrontOfTheEnd) {
  const Approach up = approach(kJoint, kOptions, 0.2, 1.0, kDt);
  EXPECT_DOUBLE_EQ(up.need, 0.5 / (0.3 - 0.02));  // 20 ms pass until motors brake
  const Approach down = approach(kJoint, kOptions, -0.7, -1.0, kDt);
  EXPECT_NEAR(down.need, -up.need, 1e-12);
  EXPECT_EQ(approach(kJoint, kOptions, 0.4, 0.0, kDt).need, 0.0);
  EXPECT_EQ(approach({.ddq_max = 6.0}, kOptions, 0.4, 1.0, kDt).need, 0.0);
}

TEST(Approach, HasRoomOnlyWhereItsEndIsFar) {
  EXPECT_EQ(approach(kJoint, kOptions, 0.3, 1.0, kDt).room.ub, 0.0);
  EXPECT_GT(approach(kJoint, kOptions, -0.9, 0.2, kDt).room.ub, 10.0);
  for (double q = -1.2; q < 0.7; q += 0.01) {
    for (double dq = -2.5; dq < 2.5; dq += 0.05) {
      ASSERT_TRUE(approach(kJoint, kOptions, q, dq, kDt).room.contains(0.0)) << q << " " << dq;
    }
  }
}

TEST(BrakingBounds, DemandTheNeedWhenTheReserveIsUsed) {
  const Approach near = approach(kJoint, kOptions, 0.35, 0.9, kDt);
  const Interval wide = {-50.0, 50.0};
  EXPECT_DOUBLE_EQ(braking_bounds(near, 1.2, wide, kJoint, kOptions, 0.9).ub, -near.need);
  EXPECT_EQ(braking_bounds(near, 1.2, wide, kJoint, kOptions, 0.9).lb, wide.lb);
  EXPECT_GT(braking_bounds(near, 4.0, wide, kJoint, kOptions, 0.9).ub, 10.0);
  const Approach away = approach(kJoint, kOptions, 0.3, 0.0, kDt);
  EXPECT_EQ(braking_bounds(away, 0.0, wide, kJoint, kOptions, 0.0).ub, wide.ub);
}

TEST(BrakingBounds, AreNeverEmptyNorBeyondTheCapOfALimit) {
  for (double q = -1.2; q < 0.7; q += 0.02) {
    for (double dq = -2.5; dq < 2.5; dq += 0.1) {
      const Interval before = limits::recoverable_bounds(kJoint, kOptions, q, dq, kDt);
      const Approach state = approach(kJoint, kOptions, q, dq, kDt);
      for (const double reserve : {0.0, 1.0, 1.7, 5.0, 100.0}) {
        const Interval bounds = braking_bounds(state, reserve, before, kJoint, kOptions, dq);
        ASSERT_LE(bounds.lb, bounds.ub);
        ASSERT_GE(bounds.lb, before.lb);
        ASSERT_LE(bounds.ub, before.ub);
        ASSERT_GE(bounds.ub, -kOptions.ddq_rec_factor * kJoint.ddq_max);
        ASSERT_LE(bounds.lb, kOptions.ddq_rec_factor * kJoint.ddq_max);
      }
    }
  }
}

TEST(BrakingBounds, ChangeGraduallyWithTheReserve) {
  const Approach near = approach(kJoint, kOptions, 0.35, 0.9, kDt);
  double before = -near.need;
  for (double reserve = 1.5; reserve < 3.0; reserve += 0.01) {
    const double ub = braking_bounds(near, reserve, {}, kJoint, kOptions, 0.9).ub;
    ASSERT_GE(ub, before);
    ASSERT_LT(ub, before + 0.15);
    before = ub;
  }
}

// Three joints with motors and two axes of a frame, in the order of Tasks.
struct Arm {
  static constexpr int kJoints = 3, kFrames = 2, kLimits = 2 * kJoints + kFrames;
  Eigen::Matrix3d mass;
  Eigen::Matrix<double, kFrames, 3> jacobian;
  std::array<Interval, kJoints> torque;
  std::array<Approach, kLimits> approaches;

  explicit Arm(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr([&] { return any(random); });
    mass = root * root.transpose() + 0.3 * Eigen::Matrix3d::Identity();
    jacobian = decltype(jacobian)::NullaryExpr([&] { return any(random); });
    for (Interval& motor : torque) motor = {-1.5 + any(random), 1.5 + any(random)};
    for (Approach& state : approaches) {
      state.need = any(random);
      state.room = {-1.0 - any(random), 1.0 + any(random)};
    }
    for (Approach& state : approaches) state.known = 0.2 * any(random);
  }
  Eigen::Vector3d row(int limit) const {
    if (limit < kJoints) return Eigen::Vector3d::Unit(limit);
    if (limit < 2 * kJoints) return mass.row(limit - kJoints);
    return jacobian.row(limit - 2 * kJoints);
  }
  static bool is_motor(int limit) { return limit >= kJoints && limit < 2 * kJoints; }
  hqp::Problem tasks() const {
    hqp::Problem problem({.variables = 3, .levels = 3, .rows = kLimits});
    problem.clear(3);
    for (int limit = 0; limit < kLimits; ++limit) {
      if (limit % kJoints == 0) problem.add_level();
      const Eigen::Vector3d c = row(limit);
      if (limit < kJoints) {
        problem.add_bound(limit, {});
      } else {
        problem.add_row({c.data(), 3}, {});
      }
    }
    return problem;
  }
  std::array<Interval, kJoints> joint_room() const {
    std::array<Interval, kJoints> room;
    for (int i = 0; i < kJoints; ++i) room[i] = approaches[i].room;
    return room;
  }
  double reserve() const {
    const hqp::Problem problem = tasks();
    JointBraking braking(problem, 0, {0, 1, 2, 3, 4, 5, 6, 7}, kJoints, kJoints);
    return braking.reserve(problem, torque, approaches, joint_room());
  }
  // a^T (ddq, mu) <= b, all of them
  std::vector<std::pair<Eigen::Vector4d, double>> half_spaces() const {
    std::vector<std::pair<Eigen::Vector4d, double>> all;
    for (int limit = 0; limit < kLimits; ++limit) {
      Eigen::Vector4d a;
      a << row(limit), is_motor(limit) ? 0.0 : approaches[limit].need;
      Interval bounds = approaches[limit].room;
      if (is_motor(limit)) bounds = torque[limit - kJoints];
      const double given = is_motor(limit) ? 0.0 : approaches[limit].known;
      all.emplace_back(a, bounds.ub - given);
      all.emplace_back(-a, given - bounds.lb);
    }
    return all;
  }
  // The largest mu of all corners; -1: there is none.
  double best_corner() const {
    const auto all = half_spaces();
    double best = -1.0;
    const std::size_t n = all.size();
    Eigen::Matrix4d A;
    Eigen::Vector4d b;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) {
        for (std::size_t k = j + 1; k < n; ++k) {
          for (std::size_t l = k + 1; l < n; ++l) {
            int at = 0;
            for (const std::size_t plane : {i, j, k, l}) {
              A.row(at) = all[plane].first;
              b[at++] = all[plane].second;
            }
            if (std::abs(A.determinant()) < 1e-9) continue;
            const Eigen::Vector4d corner = A.inverse() * b;
            if (corner[3] <= best) continue;
            bool is_inside = true;
            for (const auto& [a, most] : all) {
              is_inside = is_inside && a.dot(corner) <= most + 1e-9;
            }
            if (is_inside) best = corner[3];
          }
        }
      }
    }
    return best;
  }
};

TEST(JointBraking, ReserveIsThatOfTheBestCornerOfAllMotionsThatMotorsAllow) {
  int compared = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Arm arm(seed);
    const double best = arm.best_corner();
    if (best <= 0.0 || best > 0.9 * kMostReserve) continue;
    ASSERT_NEAR(arm.reserve(), best, 1e-6 * (1.0 + best)) << seed;
    ++compared;
  }
  EXPECT_GT(compared, 150);
}

TEST(JointBraking, HasNoReserveWhereTheMotorsCannotHoldOut) {
  Arm arm(1);
  for (Approach& state : arm.approaches) state = {.need = 1.0, .room = {-kInfinity, 0.0}};
  for (Interval& motor : arm.torque) motor = {5.0, 6.0};
  arm.mass = Eigen::Matrix3d::Identity();
  EXPECT_EQ(arm.reserve(), 0.0);
}

// A body in the plane with a motor of 1 m/s^2 along each axis, between three oblique walls of which
// the ratings promise twice that.
class Pushed {
 public:
  bool brakes_together = true;
  double worst = 0.0;  ///< largest distance beyond a wall, m

  void play(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    Eigen::Vector2d p = Eigen::Vector2d::Zero(), v = Eigen::Vector2d::Zero(), aim;
    for (int k = 0; k < 6000; ++k) {
      if (k % 400 == 0) aim = {4.0 * any(random), 4.0 * any(random)};
      const Eigen::Vector2d a = step(p, v, aim);
      p += kDt * v + 0.5 * kDt * kDt * a;
      v += kDt * a;
      for (int i = 0; i < 3; ++i) worst = std::max(worst, normal(i).dot(p) - kWall.q_max);
    }
  }

 private:
  static constexpr limits::JointLimits kWall = {.q_max = 0.6, .dq_max = 1.2, .ddq_max = 2.0};

  static Eigen::Vector2d normal(int i) {
    const double angle = 0.4 + 2.2 * i;
    return {std::cos(angle), std::sin(angle)};
  }
  Eigen::Vector2d step(const Eigen::Vector2d& p, const Eigen::Vector2d& v,
                       const Eigen::Vector2d& aim) {
    limits::RecoverableOptions options = kOptions;
    options.tau_onset = 5e-3;
    hqp::Problem problem({.variables = 2, .levels = 3, .rows = 7});
    problem.clear(2);
    problem.add_level();
    for (int i = 0; i < 2; ++i) problem.add_bound(i, {-1.0, 1.0});
    problem.add_level();
    std::array<Approach, 5> approaches;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d n = normal(i);
      problem.add_row({n.data(), 2},
                      limits::recoverable_bounds(kWall, options, n.dot(p), n.dot(v), kDt));
      approaches[i + 2] = approach(kWall, options, n.dot(p), n.dot(v), kDt);
    }
    if (brakes_together) {
      const std::array<Interval, 2> torque = {Interval{-1.0, 1.0}, Interval{-1.0, 1.0}};
      JointBraking braking(problem, 0, {0, 1, 2, 3, 4}, 0, 2);
      const double reserve = braking.reserve(problem, torque, approaches, {});
      for (int i = 0; i < 3; ++i) {
        problem.set_bounds(i + 2, braking_bounds(approaches[i + 2], reserve, problem.bounds(i + 2),
                                                 kWall, options, normal(i).dot(v)));
      }
    }
    problem.add_level();
    for (int i = 0; i < 2; ++i) problem.add_bound(i, {aim[i], aim[i]});
    hqp::Solver solver(problem.capacity());
    hqp::Solution solution(problem.capacity());
    hqp::ActiveSet active;
    solver.solve(problem, {}, active, solution);
    return {solution.x[0], solution.x[1]};
  }
};

TEST(JointBraking, WithDoubledRatingsOvershootsLessThanHalfOfPlainBraking) {
  Pushed together, alone;
  alone.brakes_together = false;
  for (unsigned seed = 0; seed < 10; ++seed) {
    together.play(seed);
    alone.play(seed);
  }
  EXPECT_GT(alone.worst, 0.0);
  EXPECT_LT(together.worst, 0.5 * alone.worst);
}

// A device whose joints all run towards their upper ends, with motors that are weaker than its
// ratings, and a free body in its hand.
class Thrown {
 public:
  DeviceModel device = unlimited_device();
  TwinModel twin = body(device);
  double speed = 1.5;       ///< Of all joints, rad/s
  bool twin_moves = false;  ///< With the handle, else it stands

  /// Every joint is so far away (rad) from its ends.
  explicit Thrown(double away = 0.3) {
    for (int i = 0; i < 6; ++i) {
      device.joint_limits[i] = {
          .q_min = kPosture[i] - away, .q_max = kPosture[i] + away, .dq_max = 3.0, .ddq_max = 10.0};
    }
    for (ActuatorModel motor : reference_actuators()) {
      motor.torque_max *= 0.5;
      device.actuators.push_back(motor);
    }
    device.has_torque_limits = true;
  }
  /// The rows of one cycle.
  Tasks tasks(const RenderingOptions& options) const {
    model::ChainData device_chain(device.chain), twin_chain(twin.chain);
    RenderingState state = Rendering(device, twin, options).start(kPosture);
    state.reference.dq_m.setConstant(speed);
    Eigen::VectorXd q(8), dq(8);
    q << kGantryAtHome, kPosture;
    dq << Eigen::Vector2d::Zero(), state.reference.dq_m;
    device_chain.update(q, dq);
    twin_chain.update(state.twin.q_a, state.twin.dq_a);
    if (twin_moves) {
      const Eigen::MatrixXd J_m = device_chain.jacobian(device.handle).rightCols(6);
      const Eigen::MatrixXd J = twin_chain.jacobian(twin.end_effector);
      state.twin.dq_a = LeastSquares(J).solve(Eigen::VectorXd(J_m * state.reference.dq_m));
      twin_chain.update(state.twin.q_a, state.twin.dq_a);
    }
    const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
    const MatrixA L = Eigen::MatrixXd(twin_chain.M()).llt().matrixL();
    const model::Jacobian J_H = device_chain.jacobian(device.handle);
    const model::Jacobian J_a = twin_chain.jacobian(twin.end_effector);
    ConstraintDirections directions(device, twin);
    directions.update(J_H, J_a);
    Tasks result(device, twin, options);
    result.fill(device, twin,
                {.device_chain = device_chain,
                 .twin_chain = twin_chain,
                 .robot = robot,
                 .reference = state.reference,
                 .twin = state.twin,
                 .inner = state.inner,
                 .motor_torque = state.motor_torque,
                 .gantry = {},
                 .touched = state.touched,
                 .L = L,
                 .J_H = J_H,
                 .J_a = J_a,
                 .directions = directions,
                 .stops = {},
                 .tau = VectorA::Zero(twin.chain.nv())});
    return result;
  }

  /// What is reported of the first cycle.
  LawResult result() const {
    Rendering rendering(device, twin, {});
    RenderingState state = rendering.start(kPosture);
    state.reference.dq_m.setConstant(speed);
    LawResult result;
    const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Constant(5.0));
    EXPECT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    return result;
  }

 private:
  static TwinModel body(const DeviceModel& device) {
    TwinModel twin =
        unlimited_twin(model::ChainModel::free_body({.mass = 1.0}, {.gravity = false}), "handle");
    twin.q_start = floating_at(handle_pose(device, kGantryAtHome, kPosture));
    return twin;
  }
};

constexpr RenderingOptions kAlone = {.braking = Braking::kAlone};
constexpr RenderingOptions kTogether;

void expect_same_bounds(const Tasks& a, const Tasks& b) {
  ASSERT_EQ(a.problem().rows(), b.problem().rows());
  for (int row = 0; row < a.problem().rows(); ++row) {
    EXPECT_EQ(a.problem().bounds(row).lb, b.problem().bounds(row).lb) << row;
    EXPECT_EQ(a.problem().bounds(row).ub, b.problem().bounds(row).ub) << row;
  }
}

TEST(BrakingTogether, OrElseEachLimitKeepsItsOwnBounds) {
  const Thrown thrown;
  const Tasks tasks = thrown.tasks(kAlone);
  EXPECT_EQ(tasks.braking_reserve(), kMostReserve);
  for (std::size_t i = 0; i < 6; ++i) {
    const LimitRow& row = tasks.limit_rows()[i];
    const Interval own = limits::recoverable_bounds(row.limits, row.options, row.q, row.dq, kDt);
    const Interval bounds = tasks.problem().bounds(tasks.first_limit_row() + static_cast<int>(i));
    EXPECT_EQ(bounds.lb, own.lb) << i;
    EXPECT_EQ(bounds.ub, own.ub) << i;
  }
}

TEST(BrakingTogether, BeginsEarlierWhereMotorsAreWeakerThanRatings) {
  const Thrown thrown;
  const Tasks alone = thrown.tasks(kAlone), together = thrown.tasks(kTogether);
  EXPECT_GT(together.braking_reserve(), 0.0);
  EXPECT_LT(together.braking_reserve(), 1.6);
  for (int row = together.first_limit_row(); row < together.first_limit_row() + 6; ++row) {
    EXPECT_EQ(together.problem().bounds(row).lb, alone.problem().bounds(row).lb) << row;
    EXPECT_LT(together.problem().bounds(row).ub, 0.0) << row;
    EXPECT_GT(alone.problem().bounds(row).ub, 0.0) << row;
  }
}

// While the handle stops in front of a wall, joints go on: one that would meet its end on the way
// cannot help to the end.
TEST(BrakingTogether, AJointThatMeetsItsEndOnTheWayBrakesNoWall) {
  const auto reserve = [](double away) {
    Thrown thrown(away);
    const double y = handle_pose(thrown.device, kGantryAtHome, kPosture).p.y();
    thrown.device.cartesian_limits = {
        {.name = "hand", .frame = thrown.device.handle, .axes = {}, .margin = 0.0}};
    thrown.device.cartesian_limits[0].axes[1] = {y - 0.3, y + 0.3, 3.0, 5.0};
    return thrown.tasks(kTogether).braking_reserve();
  };
  constexpr double kFar = 3.0, kOnTheWay = 1.5;  // rad; even this is no end that is near
  ASSERT_LT(reserve(kFar), kMostReserve);
  EXPECT_LT(reserve(kOnTheWay), 0.5 * reserve(kFar));
}

// A twin that meets its own end at the same time uses the same motors.
TEST(BrakingTogether, AnEndOfTheTwinUsesUpTheReserve) {
  const auto reserve = [](double away) {
    Thrown thrown(0.15);
    thrown.speed = 0.8;
    thrown.twin_moves = true;
    for (int i = 0; i < 3; ++i) {
      limits::JointLimits& limits = thrown.twin.dofs[i].limits;
      limits.q_min = thrown.twin.q_start[i] - away;
      limits.q_max = thrown.twin.q_start[i] + away;
      limits.ddq_max = 5.0;
    }
    return thrown.tasks(kTogether).braking_reserve();
  };
  EXPECT_GT(reserve(10.0), 0.1);
  EXPECT_LT(reserve(0.1), 0.8 * reserve(10.0));
}

TEST(BrakingTogether, NamesLimitsThatMakeTheDeviceSlower) {
  const auto braking = [](double speed) {
    Thrown thrown;
    thrown.speed = speed;
    const LawResult result = thrown.result();
    return std::count_if(
        result.limits.begin(), result.limits.begin() + 6,
        [](const LimitReport& limit) { return limit.cause == LimitCause::kBraking; });
  };
  EXPECT_GT(braking(1.5), 0);
  EXPECT_EQ(braking(0.01), 0);
}

TEST(BrakingTogether, EqualsBrakingAloneWithoutMotorModel) {
  Thrown thrown;
  thrown.device.has_torque_limits = false;
  EXPECT_FALSE(brakes_together(thrown.device, kTogether));
  expect_same_bounds(thrown.tasks(kTogether), thrown.tasks(kAlone));
}

TEST(BrakingTogether, IsOnlyForLawGaussWithRecoverableBounds) {
  const DeviceModel device = Thrown().device;
  EXPECT_TRUE(brakes_together(device, kTogether));
  EXPECT_FALSE(brakes_together(device, kAlone));
  EXPECT_FALSE(brakes_together(device, {.law = Law::kPaper}));
  EXPECT_FALSE(brakes_together(device, {.bounds = Bounds::kPaper}));
}

}  // namespace
}  // namespace hg::rendering
