// Values of a twin that change while a hand holds it: by how much their change is felt.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hg/controller/rendering/test/playing.h"
#include "hg/core/error.h"

namespace hg::rendering {
namespace {

constexpr double kForceRate = 25.0;  // N/s; up to a tenth more where a change takes long
constexpr double kOnset = 0.05;      // s

// A door that a hand holds at 0.8 rad, or moves there at a steady speed; only its values change.
struct SteadyDoor {
  TwinModel twin = door();
  TwinParameters parameters = initial_parameters(twin);
  TwinState state;
  FeltBy felt;
  double lever;  // m

  explicit SteadyDoor(double speed = 0.0) {
    state.q_a = Eigen::Vector2d(0.8, 0.0);
    state.dq_a = Eigen::Vector2d(speed, 0.0);
    state.ddq_a = Eigen::Vector2d::Zero();
    model::ChainData chain(twin.chain);
    chain.update(state.q_a, state.dq_a);
    felt.J_a = chain.jacobian(twin.end_effector);
    felt.motion = felt.weight = Eigen::Vector2d::Zero();
    felt.w_H = Vector6::Zero();
    lever = felt.J_a.col(0).head<3>().norm();
  }

  void change(Parameter parameter, double value) {
    ASSERT_EQ(apply(twin, {parameter, 0, value}, parameters), ChangeStatus::kTaken);
  }

  double force() const {
    const DofValues& now = parameters.now.dofs[0];
    const double dq = state.dq_a[0];
    const double torque = now.preload + now.stiffness * (state.q_a[0] - now.rest) +
                          now.damping * dq + now.quadratic_damping * std::abs(dq) * dq +
                          now.friction;
    return torque / lever;
  }

  void step() { advance_parameters(twin, state, kDt, felt, parameters); }

  // the largest change of the force in a cycle, N
  double run(double seconds) {
    double largest = 0.0;
    for (int k = 0; k < static_cast<int>(seconds / kDt); ++k) {
      const double before = force();
      step();
      largest = std::max(largest, std::abs(force() - before));
    }
    return largest;
  }
};

TEST(ChangedValues, ChangeTheForceByABoundedRate) {
  struct Case {
    Parameter parameter;
    double value, speed;
  };
  for (const Case& c :
       {Case{Parameter::kStiffness, 50.0, 0.0}, Case{Parameter::kPreload, -30.0, 0.0},
        Case{Parameter::kDamping, 60.0, 0.5}, Case{Parameter::kQuadraticDamping, 90.0, -0.5},
        Case{Parameter::kFriction, 25.0, 0.1}, Case{Parameter::kRest, -1.0, 0.0}}) {
    SCOPED_TRACE(static_cast<int>(c.parameter));
    SteadyDoor door(c.speed);
    door.parameters.now.dofs[0].stiffness = c.parameter == Parameter::kRest ? 30.0 : 0.0;
    door.parameters.target = door.parameters.now;
    const double before = door.force();
    door.change(c.parameter, c.value);
    const double largest = door.run(0.5);
    EXPECT_LT(largest, 1.1 * kForceRate * kDt);
    EXPECT_GT(largest, 0.9 * kForceRate * kDt);
    EXPECT_LT(door.run(6.0), 1.1 * kForceRate * kDt);
    EXPECT_GT(std::abs(door.force() - before), 10.0);
    EXPECT_FALSE(is_changing(door.twin, door.parameters));
  }
}

// The rate of force begins at nothing, also a second time.
TEST(ChangedValues, BeginSmoothly) {
  SteadyDoor door;
  for (const double preload : {20.0, 0.0}) {
    door.change(Parameter::kPreload, preload);
    double before = door.force(), rate = 0.0;
    for (int k = 0; k < 100; ++k) {
      door.step();
      const double now = std::abs(door.force() - before) / kDt;
      EXPECT_LT(now - rate, kForceRate * kDt / kOnset * (1.0 + 1e-6)) << k;
      before = door.force();
      rate = now;
    }
    EXPECT_NEAR(rate, kForceRate, 0.1);
    door.run(6.0);
    EXPECT_EQ(door.parameters.pace, 0.0);
  }
}

TEST(ChangedValues, ThatAreNotFeltAreThereAsSoonAsEver) {
  SteadyDoor door;  // at rest, where the spring will be relaxed
  door.parameters.now.dofs[0].rest = door.parameters.target.dofs[0].rest = 0.8;
  door.change(Parameter::kStiffness, 1000.0);
  door.change(Parameter::kDamping, 100.0);
  door.run(0.1);
  EXPECT_NEAR(door.parameters.now.dofs[0].stiffness, 1000.0 * (1.0 - std::exp(-1.0)), 1e-6);
  EXPECT_NEAR(door.parameters.now.dofs[0].damping, 100.0 * (1.0 - std::exp(-1.0)), 1e-6);
}

TEST(ChangedValues, OfLittleForceAreThereWithinASecond) {
  SteadyDoor door;
  door.change(Parameter::kPreload, 1.0);
  door.run(0.35);
  EXPECT_GT(door.parameters.now.dofs[0].preload, 0.95);
}

// A spring that is to be relaxed where the joint is: its rest arrives before its stiffness.
TEST(ChangedValues, OfARelaxedSpringAreHardlyFeltOnTheWay) {
  SteadyDoor door;
  door.change(Parameter::kRest, 0.8);
  door.change(Parameter::kStiffness, 400.0);
  double most = 0.0;
  for (int k = 0; k < 3000; ++k) {
    door.step();
    most = std::max(most, std::abs(door.force()));
  }
  EXPECT_LT(most, 3.0);  // N; 107 N if both came alike
  EXPECT_NEAR(door.parameters.now.dofs[0].stiffness, 400.0, 1e-3);
}

TEST(ChangedValues, OfAnySizeArriveWithinSeconds) {
  SteadyDoor door;
  door.change(Parameter::kPreload, 1e4);
  door.run(16.0);
  EXPECT_NEAR(door.parameters.now.dofs[0].preload, 1e4, 10.0);
}

// The hand carries the weight of a body and accelerates it.
TEST(ChangedValues, OfMassChangeWeightAndInertiaByABoundedRate) {
  TwinModel twin =
      unlimited_twin(model::ChainModel::free_body({.mass = 3.0}, {.gravity = true}), "handle");
  Playing body(twin);
  const auto push = [&](double force) {
    Vector6 w = Vector6::Zero();
    w[2] = force;
    return w;
  };
  double mass = 3.0, largest = 0.0;
  ASSERT_EQ(body.change(Parameter::kMassScale, -1, 2.0), ChangeStatus::kTaken);
  for (int k = 0; k < 4000; ++k) {
    // what this acceleration needs now
    ASSERT_NO_FATAL_FAILURE(body.step(push(mass * (9.81 + 1.0))));
    const double now = 3.0 * body.state.inner.parameters.now.loads.mass;
    largest = std::max(largest, (now - mass) * (9.81 + 1.0));
    mass = now;
  }
  EXPECT_NEAR(mass, 6.0, 1e-6);
  EXPECT_LT(largest, 1.05 * kForceRate * kDt);
  EXPECT_GT(largest, 0.9 * kForceRate * kDt);
}

TwinModel body_of(double mass) {
  return unlimited_twin(model::ChainModel::free_body({.mass = mass}, {.gravity = false}), "handle");
}

TEST(FeltScale, MultipliesTheUsersForceOnTheTwinAxisByAxis) {
  Playing body(body_of(4.0));
  ASSERT_EQ(body.change(Parameter::kFeltScale, 0, 2.0), ChangeStatus::kTaken);
  Vector6 w = Vector6::Zero();
  w.head<2>() << 20.0, 20.0;
  for (int k = 0; k < 6000; ++k) ASSERT_NO_FATAL_FAILURE(body.step(w));
  EXPECT_NEAR(body.state.twin.ddq_a[0], 2.0 * 20.0 / 4.0, 1e-9);
  EXPECT_NEAR(body.state.twin.ddq_a[1], 20.0 / 4.0, 1e-9);
  EXPECT_NEAR(body.rendering.apparent_mass(body.state), 2.0, 1e-9);
  EXPECT_LT(body.worst_gap, 1e-9);
  EXPECT_EQ(body.result.felt_scale[0], 2.0);
}

// 20 N are held all the time: twice the force on the twin comes as slowly as a change of 20 N.
TEST(FeltScale, ChangesWithoutAStepWhileTheTwinIsPulled) {
  Playing body(body_of(4.0));
  Vector6 w = Vector6::Zero();
  w[0] = 20.0;
  body.step(w);
  body.worst_jump = 0.0;
  ASSERT_EQ(body.change(Parameter::kFeltScale, 0, 2.0), ChangeStatus::kTaken);
  for (int k = 0; k < 6000; ++k) ASSERT_NO_FATAL_FAILURE(body.step(w));
  // the twin feels S w: its rate is at most s times that of what is felt
  EXPECT_LT(body.worst_jump, 2.0 * kForceRate * kDt / 4.0);
  EXPECT_GT(body.worst_jump, 0.5 * kForceRate * kDt / 4.0);
}

TEST(FeltScale, IsRefusedBeyondItsRangeAndForOtherThanSixComponents) {
  Playing body(body_of(4.0));
  const RenderingState before = body.state;
  for (const double value : {0.05, 10.5, -1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(body.change(Parameter::kFeltScale, 0, value), ChangeStatus::kRefused) << value;
  }
  EXPECT_EQ(body.change(Parameter::kFeltScale, 6, 2.0), ChangeStatus::kRefused);
  EXPECT_EQ(body.change(Parameter::kFeltScale, -1, 2.0), ChangeStatus::kRefused);
  EXPECT_EQ(body.state.inner.parameters.target.felt_scale,
            before.inner.parameters.target.felt_scale);
  TwinModel twin = body_of(4.0);
  twin.felt_scale[5] = 11.0;
  EXPECT_THROW(check_twin_model(twin), SetupError);
}

// Springs, and what bearings carry, are felt divided by the scale.
TEST(FeltScale, DividesWhatTheTwinDoesToTheHand) {
  TwinModel twin = door();
  twin.felt_scale << 2.0, 2.0, 2.0, 2.0, 2.0, 2.0;
  twin.dofs[0].preload = 10.0;
  twin.q_start[0] = 0.8;
  Playing door(twin);
  const Vector6 w = door.wrench_for(0, 5.0);  // half of what the preload pulls
  ASSERT_NO_FATAL_FAILURE(door.step(w));
  EXPECT_LT(door.state.twin.ddq_a.norm(), 1e-9);

  // upwards only the bearings carry
  Vector6 lifted = w;
  lifted[2] += 8.0;
  Playing other(twin);
  ASSERT_NO_FATAL_FAILURE(other.step(lifted));
  const Vector6 more = other.result.budget.structure - door.result.budget.structure;
  const model::Jacobian J_a = other.rendering.twin_chain().jacobian(twin.end_effector);
  EXPECT_NEAR((J_a.transpose() * more).norm(), 0.0, 1e-6);
  EXPECT_GT(more.norm(), 1.0);
  EXPECT_LT(more.norm(), 8.0 + 1e-9);
  EXPECT_LT(other.worst_gap, 1e-9);
}

}  // namespace
}  // namespace hg::rendering
