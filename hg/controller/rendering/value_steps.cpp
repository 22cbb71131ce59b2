#include "hg/controller/rendering/value_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace hg::rendering {
namespace {

constexpr double kArrived = 1e-9;                       // of the larger of 1 and the target
constexpr double kForceRate = 25.0, kTorqueRate = 2.5;  // N/s, Nm/s
constexpr double kOnset = 0.05;                         // s
constexpr double kPatience = 1.0, kGrowth = 0.01;       // s, share
constexpr double kFelt = 1e-9;                          // m or 1

// A value on its way, and what the user feels of it: per unit of the value, over what a cycle may
// change
struct Step {
  double& now;
  double target;
  double effect;

  double felt(double share) const noexcept { return share * effect * (target - now); }
};

// How far values may go in one cycle.
struct Pace {
  double share;  // of the distance to the target where nothing is felt
  double most;   // of what a cycle may change in the force
};

// the part of a step that feels like `felt` and may feel like `pace.most`
double part(double felt, const Pace& pace) noexcept {
  return std::abs(felt) > pace.most ? pace.most / std::abs(felt) : 1.0;
}

// Advances values that are felt together. Returns what is felt of one of them or of all, whichever
// is more, over what a cycle may change.
template <std::size_t kSize>
double advance(std::array<Step, kSize>&& steps, const Pace& pace) noexcept {
  std::array<double, kSize> parts;
  double together = 0.0;
  for (std::size_t i = 0; i < kSize; ++i) {
    parts[i] = part(steps[i].felt(pace.share), pace);
    together += steps[i].felt(parts[i] * pace.share);
  }
  const double of_all = part(together, pace);
  double most = 0.0;
  for (std::size_t i = 0; i < kSize; ++i) {
    const double share = parts[i] * of_all * pace.share;
    most = std::max(most, std::abs(steps[i].felt(share)));
    approach(steps[i].now, steps[i].target, share);
  }
  return std::max(most, std::abs(together * of_all));
}

// Most of what a cycle may change after one in which changes took `before` of it: up to all of it
// within the onset; it grows beyond, by e in a second, while a change takes more than some seconds.
double most_after(double before, double dt) noexcept {
  if (before < 1.0) return std::min(1.0, before + dt / kOnset);
  return before + dt / kPatience * (before - 1.0 + kGrowth);
}

// Largest change of the torque of each joint in a cycle, Nm or N; infinite where the user feels
// nothing of it.
VectorA most_torque(const FeltBy& felt, const Vector6& scale, double dt) noexcept {
  VectorA most(felt.J_a.cols());
  for (Eigen::Index i = 0; i < most.size(); ++i) {
    const Vector6 column = scale.cwiseProduct(felt.J_a.col(i));
    const double lever = column.head<3>().norm(), turn = column.tail<3>().norm();
    const bool is_felt = std::max(lever, turn) > kFelt;
    most[i] = is_felt ? dt * std::max(kForceRate * lever, kTorqueRate * turn) : kInfinity;
  }
  return most;
}

double advance_dof(double q, double dq, double most, const DofValues& goal, const Pace& pace,
                   DofValues& now) noexcept {
  const double sense = dq < 0.0 ? -1.0 : 1.0;
  return advance(
      std::array{
          Step{now.stiffness, goal.stiffness, (q - now.rest) / most},
          Step{now.rest, goal.rest, -now.stiffness / most},
          Step{now.preload, goal.preload, 1.0 / most},
          Step{now.damping, goal.damping, dq / most},
          Step{now.quadratic_damping, goal.quadratic_damping, std::abs(dq) * dq / most},
          Step{now.friction, goal.friction, sense / most},
      },
      pace);
}

double advance_loads(const FeltBy& felt, const VectorA& most, const model::Loads& goal,
                     const Pace& pace, model::Loads& now) noexcept {
  double mass = 0.0, gravity = 0.0;
  for (Eigen::Index i = 0; i < most.size(); ++i) {
    const double moved = felt.motion[i] + now.gravity * felt.weight[i];
    mass = std::max(mass, std::abs(moved) / (most[i] * now.mass));
    gravity = std::max(gravity, std::abs(felt.weight[i]) / most[i]);
  }
  return advance(
      std::array{Step{now.mass, goal.mass, mass}, Step{now.gravity, goal.gravity, gravity}}, pace);
}

// Twice the scale at the same forces of the twin is half of the user's.
double advance_scale(const Vector6& w, double dt, const Vector6& goal, const Pace& pace,
                     Vector6& now) noexcept {
  double felt = 0.0;
  for (int i = 0; i < 6; ++i) {
    const double most = dt * (i < 3 ? kForceRate : kTorqueRate);
    const double effect = std::abs(w[i]) / (most * now[i]);
    felt = std::max(felt, advance(std::array{Step{now[i], goal[i], effect}}, pace));
  }
  return felt;
}

}  // namespace

void approach(double& now, double target, double share) noexcept {
  if (now == target) return;
  now += share * (target - now);
  if (std::abs(target - now) <= kArrived * std::max(1.0, std::abs(target))) now = target;
}

double share_of_step(double dt, double time_constant) noexcept {
  return -std::expm1(-dt / time_constant);
}

void approach_targets(const TwinModel& twin, const TwinState& state, double dt, const FeltBy& felt,
                      TwinParameters& parameters) noexcept {
  TwinValues& now = parameters.now;
  const TwinValues& goal = parameters.target;
  const Pace pace = {share_of_step(dt, kApproach), most_after(parameters.pace, dt)};
  const VectorA torque = most_torque(felt, now.felt_scale, dt);
  double used = advance_loads(felt, torque, goal.loads, pace, now.loads);
  used = std::max(used, advance_scale(felt.w_H, dt, goal.felt_scale, pace, now.felt_scale));
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    const TwinDof& dof = twin.dofs[static_cast<std::size_t>(i)];
    const double q = dof.q_index < 0 ? 0.0 : state.q_a[dof.q_index];
    used =
        std::max(used, advance_dof(q, state.dq_a[i], torque[i], goal.dofs[i], pace, now.dofs[i]));
  }
  parameters.pace = is_changing(twin, parameters) ? used : 0.0;
}

}  // namespace hg::rendering
