// A twin that meets a virtual surface.

#include <gtest/gtest.h>

#include "hg/rendering/test/playing.h"

namespace hg::rendering {
namespace {

constexpr double kMass = 3.0;
constexpr double kStiffness = 4000.0;

// A free body above a floor at z = 0.
struct Falling {
  Rendering rendering;
  State state;
  CycleRecord record;

  static TwinModel body() {
    TwinModel twin =
        unlimited_twin(model::Chain::free_body({.mass = kMass}, {.gravity = false}), "handle");
    twin.q_start = floating_at({{0.4, 0.1, 0.001}, Eigen::Matrix3d::Identity()});
    return twin;
  }
  Falling()
      : rendering(
            unlimited_device(), body(), without_synchronisation(),
            environment::Environment(
                {{.name = "floor", .shape = environment::Plane{}, .stiffness = kStiffness}}, kDt)),
        state(rendering.start(kPosture)) {}

  void step(const Vector6& w, double share = 1.0, double braking_rate = 0.0) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    record = record_with(kGantryAtHome, kPosture, w);
    ASSERT_EQ(rendering.step(state, braking_rate, record, share), SolverStatus::kSolved);
    ASSERT_LT(budget_gap(record, rendering.twin().chain.M()), 1e-9);
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
  EXPECT_EQ(twin.record.contact.surface, 0);
  EXPECT_NEAR(twin.record.contact.force.z(), 20.0, 1e-3);
  EXPECT_NEAR(twin.record.contact.proxy.z(), 0.0, 1e-8);
  EXPECT_NEAR(twin.record.budget.surface[2], -20.0, 1e-3);
}

TEST(TwinOnASurface, FeelsOnlyTheShareOfIt) {
  Falling twin;
  twin.state.twin.q_a[2] = -0.004;
  twin.state.contact = {{0.4, 0.1, 0.0}, true};
  twin.step(Vector6::Zero(), 0.25);
  EXPECT_NEAR(twin.record.contact.force.z(), 4.0, 1e-4);
  EXPECT_NEAR(twin.state.twin.ddq_a[2], 4.0 / kMass, 1e-4);
}

TEST(TwinOnASurface, FeelsNothingWhileItIsBraked) {
  Falling twin;
  twin.state.twin.q_a[2] = -0.004;
  twin.state.contact = {{0.4, 0.1, 0.0}, true};
  twin.step(Vector6::Zero(), 0.0, 20.0);
  EXPECT_EQ(twin.record.contact.force.norm(), 0.0);
  EXPECT_EQ(twin.record.budget.surface.norm(), 0.0);
  EXPECT_NEAR(twin.state.contact.proxy.z(), 0.0, 1e-8);
}

}  // namespace
}  // namespace hg::rendering
