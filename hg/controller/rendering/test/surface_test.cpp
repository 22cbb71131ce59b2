// A twin that meets a virtual surface.

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "hg/controller/rendering/test/playing.h"

namespace hg::rendering {
namespace {

constexpr double kMass = 3.0;
constexpr double kStiffness = 4000.0;

// A free body above a floor at z = 0.
struct Falling {
  Rendering rendering;
  RenderingState state;
  LawResult result;

  static TwinModel body() {
    TwinModel twin =
        unlimited_twin(model::ChainModel::free_body({.mass = kMass}, {.gravity = false}), "handle");
    twin.q_start = floating_at({{0.4, 0.1, 0.001}, Eigen::Matrix3d::Identity()});
    return twin;
  }
  Falling()
      : rendering(unlimited_device(), body(), without_synchronisation(),
                  surfaces::Environment({{.name = "floor",
                                          .shape = surfaces::Plane{},
                                          .stiffness = kStiffness,
                                          .damping = 20.0}},
                                        kDt, {kMass, kMass})),
        state(rendering.start(kPosture)) {}

  void step(const Vector6& w, double share = 1.0, double braking_rate = 0.0) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
    ASSERT_EQ(rendering.step({.robot = robot, .braking_rate = braking_rate, .force_share = share},
                             state, result),
              SolverStatus::kSolved);
    ASSERT_LT(budget_gap(result, rendering.twin_chain().M()), 1e-9);
    rendering.integrate(state);
  }
};

TEST(TwinOnASurface, RestsWhereTheSurfaceCarriesTheUser) {
  Falling twin;
  Vector6 push = Vector6::Zero();
  push.z() = -20.0;
  for (int k = 0; k < 5000; ++k) {
    // the hand's own damper
    Vector6 w = push;
    w.z() -= 40.0 * twin.state.twin.dq_a[2];
    twin.step(w);
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_NEAR(twin.state.twin.q_a[2], -20.0 / kStiffness, 1e-6);
  EXPECT_EQ(twin.result.contact.surface, 0);
  EXPECT_NEAR(twin.result.contact.force.z(), 20.0, 1e-3);
  EXPECT_NEAR(twin.result.contact.proxy.z(), 0.0, 1e-8);
  EXPECT_NEAR(twin.result.budget.surface[2], -20.0, 1e-3);
}

// With a scale of 4 the surface carries four times the hand's force, and the hand feels its own.
TEST(TwinOnASurface, IsFeltDividedByTheScale) {
  Falling twin;
  TwinParameters& parameters = twin.state.inner.parameters;
  parameters.now.felt_scale[2] = parameters.target.felt_scale[2] = 4.0;
  for (int k = 0; k < 5000; ++k) {
    Vector6 w = Vector6::Zero();
    w.z() = -5.0 - 10.0 * twin.state.twin.dq_a[2];
    twin.step(w);
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_NEAR(twin.state.twin.q_a[2], -20.0 / kStiffness, 1e-6);
  EXPECT_NEAR(twin.result.contact.force.z(), 5.0, 1e-3);
  EXPECT_NEAR(twin.result.budget.surface[2], -20.0, 1e-3);
}

// A surface that says no damping brakes what comes in, and carries the weight of the twin besides.
TEST(TwinOnASurface, CarriesATwinThatHasWeight) {
  TwinModel twin =
      unlimited_twin(model::ChainModel::free_body({.mass = kMass}, {.gravity = true}), "handle");
  twin.q_start = floating_at({{0.4, 0.1, 0.05}, Eigen::Matrix3d::Identity()});
  Rendering rendering(unlimited_device(), twin, without_synchronisation(),
                      surfaces::Environment(
                          {{.name = "floor", .shape = surfaces::Plane{}, .stiffness = kStiffness}},
                          kDt, {kMass, kMass}));
  RenderingState state = rendering.start(kPosture);
  for (int k = 0; k < 3000; ++k) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
    LawResult result;
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    rendering.integrate(state);
    ASSERT_GT(state.twin.q_a[2], -0.03) << k;
  }
  EXPECT_NEAR(state.twin.q_a[2], -kMass * 9.81 / kStiffness, 1e-3);
}

// A twin that has become twice as heavy meets a surface like one that was set up so.
TEST(TwinOnASurface, IsCaughtWithTheMassThatItHasNow) {
  const auto played = [](double mass, double scale) {
    TwinModel twin = Falling::body();
    twin.chain = model::ChainModel::free_body({.mass = mass}, {.gravity = false});
    Rendering rendering(
        unlimited_device(), twin, without_synchronisation(),
        surfaces::Environment(
            {{.name = "floor", .shape = surfaces::Plane{}, .stiffness = kStiffness}}, kDt,
            {mass, mass}));
    RenderingState state = rendering.start(kPosture);
    state.inner.parameters.now.loads.mass = state.inner.parameters.target.loads.mass = scale;
    state.twin.dq_a[2] = -0.3;
    for (int k = 0; k < 60; ++k) {
      state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
      const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
      LawResult result;
      rendering.step({.robot = robot}, state, result);
      rendering.integrate(state);
    }
    return std::pair{state.twin.q_a[2], state.twin.dq_a[2]};
  };
  const auto [z, v] = played(2.0 * kMass, 1.0);
  const auto [z_grown, v_grown] = played(kMass, 2.0);
  EXPECT_NEAR(z_grown, z, 1e-9);
  EXPECT_NEAR(v_grown, v, 1e-7);
}

TEST(TwinOnASurface, FeelsOnlyTheShareOfIt) {
  Falling twin;
  twin.state.twin.q_a[2] = -0.004;
  twin.state.contact = {{0.4, 0.1, 0.0}, true};
  twin.step(Vector6::Zero(), 0.25);
  EXPECT_NEAR(twin.result.contact.force.z(), 4.0, 1e-4);
  EXPECT_NEAR(twin.state.twin.ddq_a[2], 4.0 / kMass, 1e-4);
}

// A fall into a stiff floor: depth and fastest way back, m and m/s.
std::pair<double, double> fall(double ddq_max) {
  DeviceModel device = unlimited_device();
  for (limits::JointLimits& joint : device.joint_limits) joint.ddq_max = ddq_max;
  Rendering rendering(
      device, Falling::body(), without_synchronisation(),
      surfaces::Environment(
          {{.name = "floor", .shape = surfaces::Plane{}, .stiffness = 2e4, .damping = 0.0}}, kDt,
          {kMass, kMass}));
  RenderingState state = rendering.start(kPosture);
  state.twin.dq_a[2] = -0.5;
  double depth = 0.0, back = 0.0;
  for (int k = 0; k < 1000; ++k) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    const RobotState robot = robot_with(kGantryAtHome, kPosture, Vector6::Zero());
    LawResult result;
    rendering.step({.robot = robot}, state, result);
    rendering.integrate(state);
    depth = std::max(depth, -state.twin.q_a[2]);
    back = std::max(back, state.twin.dq_a[2]);
  }
  return {depth, back};
}

TEST(TwinOnASurface, IsNotThrownBackByAForceThatTheDeviceCannotGive) {
  const auto [depth, back] = fall(kInfinity);
  EXPECT_NEAR(depth, 0.5 * std::sqrt(kMass / 2e4), 1e-3);
  EXPECT_NEAR(back, 0.5, 0.02);
  const auto [weak_depth, weak_back] = fall(6.0);
  EXPECT_GT(weak_depth, 3.0 * depth);
  EXPECT_LT(weak_back, 0.05);
}

TEST(TwinOnASurface, FeelsNothingWhileItIsBraked) {
  Falling twin;
  twin.state.twin.q_a[2] = -0.004;
  twin.state.contact = {{0.4, 0.1, 0.0}, true};
  twin.step(Vector6::Zero(), 0.0, 20.0);
  EXPECT_EQ(twin.result.contact.force.norm(), 0.0);
  EXPECT_EQ(twin.result.budget.surface.norm(), 0.0);
  EXPECT_NEAR(twin.state.contact.proxy.z(), 0.0, 1e-8);
}

}  // namespace
}  // namespace hg::rendering
