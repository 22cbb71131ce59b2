/// Twins on their own, stepped through time: what the tests of a twin share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "hg/controller/rendering/test/test_models.h"
#include "hg/core/linear_algebra.h"

namespace hg::rendering {

inline const VectorM kPosture = posture({0.3, 1.5, -0.6, 1.3, 0.2, 2.1});
inline const Eigen::Vector2d kGantryAtHome = Eigen::Vector2d::Zero();
inline constexpr double kDt = 1e-3;
inline constexpr int kFirstTwinLimit = 6;  // the device has six joints and nothing else

// what does not add up, relative to the largest of what is added: M ddq_a is a sum itself, and on
// an ill-conditioned twin one of large terms
inline double budget_gap(const LawResult& result, const Eigen::MatrixXd& M) {
  const Budget& b = result.budget;
  const VectorA rest = b.inertia + b.damping + b.friction + b.spring + b.surface + b.limits +
                       b.conflict - result.tau_a;
  const VectorA terms = M.cwiseAbs() * result.ddq_a.cwiseAbs();
  const double scale = std::max({1.0, terms.norm(), b.damping.norm(), result.tau_a.norm()});
  return rest.norm() / scale;
}

// A twin on its own: the device has no limits and no synchronisation.
struct Playing {
  Rendering rendering;
  RenderingState state;
  RobotState robot;
  LawResult result;
  double worst_gap = 0.0;
  double worst_jump = 0.0;  // of a twin acceleration from one cycle to the next
  VectorA last_ddq;
  int changes = 0;  // of limits that act

  explicit Playing(const TwinModel& twin,
                   const RenderingOptions& options = without_synchronisation())
      : rendering(unlimited_device(), twin, options), state(rendering.start(kPosture)) {}

  void step(const Vector6& w) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    robot = robot_with(kGantryAtHome, kPosture, w);
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    worst_gap = std::max(worst_gap, budget_gap(result, rendering.twin_chain().M()));
    const VectorA& ddq = state.twin.ddq_a;
    if (last_ddq.size() > 0)
      worst_jump = std::max(worst_jump, (ddq - last_ddq).cwiseAbs().maxCoeff());
    last_ddq = ddq;
    changes += result.active_set_changes;
    rendering.integrate(state);
  }

  // a wrench that puts `torque` on the twin's joint `dof`
  Vector6 wrench_for(int dof, double torque) {
    model::ChainData chain(rendering.twin().chain);
    chain.update_kinematics(state.twin.q_a, state.twin.dq_a);
    const Eigen::MatrixXd J_a_T = chain.jacobian(rendering.twin().end_effector).transpose();
    const Eigen::VectorXd tau = torque * Eigen::VectorXd::Unit(J_a_T.rows(), dof);
    return LeastSquares(J_a_T).solve(tau);
  }

  void run(double seconds, int dof, double torque) {
    for (int k = 0; k < static_cast<int>(seconds / kDt); ++k) {
      step(wrench_for(dof, torque));
      if (testing::Test::HasFatalFailure()) return;
    }
  }

  ChangeStatus change(Parameter parameter, int index, double value) {
    return rendering.change({parameter, static_cast<std::int16_t>(index), value}, state);
  }
  double q(int dof) const { return state.twin.q_a[dof]; }
  double dq(int dof) const { return state.twin.dq_a[dof]; }
  const LimitReport& limit(int dof) const { return result.limits[kFirstTwinLimit + dof]; }
};

inline TwinModel door() {
  TwinModel twin = unlimited_twin(
      model::ChainModel::from_urdf_file("models/twins/door/door.urdf", {.gravity = false}),
      "handle");
  twin.dofs[0].limits = {0.0, 1.75, kInfinity, 6.0};
  twin.dofs[1].limits = {0.0, 0.80, 3.0, 35.0};
  return twin;
}

// The same, pulled shut by a closer, with a handle that springs back.
inline TwinModel door_with_closer() {
  TwinModel twin = door();
  twin.dofs[0].limits = {0.0, 1.75, 1.2, 25.0};
  twin.dofs[1].limits = {0.0, 0.80, 6.0, 200.0};
  twin.dofs[0].stiffness = 4.0;
  twin.dofs[0].preload = 3.0;
  twin.dofs[1].stiffness = 1.2;
  twin.dofs[1].preload = 0.6;
  twin.dofs[0].damping = 2.0;
  twin.dofs[1].damping = 0.05;
  return twin;
}

// Holds the door shut until its handle is pressed.
inline Lock door_lock() {
  return {.name = "bolt",
          .dof = 0,
          .position = 0.0,
          .engaged_while = {{.dof = 0, .range = {-kInfinity, 0.03}},
                            {.dof = 1, .range = {-kInfinity, 0.50}}}};
}

// A URDF of `joints` joints in a row, the last link of mass `last_mass`, kg.
inline std::string snake(int joints, double last_mass) {
  std::ostringstream text;
  text << "<robot name='snake'><link name='l0'/>";
  for (int i = 1; i <= joints; ++i) {
    const double mass = i == joints ? last_mass : 1.0;
    text << "<link name='l" << i << "'><inertial><origin xyz='0.05 0.01 0'/><mass value='" << mass
         << "'/><inertia ixx='" << 1e-3 * mass << "' iyy='" << 1e-3 * mass << "' izz='"
         << 1e-3 * mass << "' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j" << i
         << "' type='" << (i % 5 == 0 ? "prismatic" : "continuous") << "'><parent link='l" << i - 1
         << "'/><child link='l" << i << "'/><origin xyz='0.1 0 0'/><axis xyz='"
         << (i % 3 == 0   ? "1 0 0"
             : i % 3 == 1 ? "0 1 0"
                          : "0 0 1")
         << "'/><limit lower='-1' upper='1'/></joint>";
  }
  text << "</robot>";
  return text.str();
}

}  // namespace hg::rendering
