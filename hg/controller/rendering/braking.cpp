#include "hg/controller/rendering/braking.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "hg/controller/rendering/motor_torque.h"
#include "hg/core/stacked.h"
#include "hg/hqp/solver.h"
#include "hg/model/chain_data.h"

namespace hg::rendering {
namespace {

constexpr double kBeyond = 1e4;  // m/s^2; no handle accelerates like that

double rating(const DeviceModel& device, const Eigen::Vector3d& direction) {
  double least = kInfinity;
  const auto limits = handle_limits(device);
  for (std::size_t axis = 0; axis < limits.size(); ++axis) {
    const double share = std::abs(direction[axis]);
    if (share > 0.0) least = std::min(least, limits[axis].ddq_max / share);
  }
  return least;
}

}  // namespace

double largest_acceleration(const DeviceModel& device, const DeviceMotion& motion,
                            const Eigen::Vector3d& direction) {
  if (device.motors().empty()) return rating(device, direction);
  const int n_p = device.n_p, n_m = device.n_m;
  model::ChainData chain(device.chain);
  chain.update(stacked(motion.q_p, motion.q_m), stacked(motion.dq_p, motion.dq_m));
  const auto J = chain.jacobian(device.handle).middleCols(n_p, n_m).eval();
  const Vector6 bias = chain.bias_acceleration(device.handle);
  const Eigen::VectorXd h = chain.c().tail(n_m) - J.transpose() * motion.w_H;

  // x = (ddq_m, acceleration along `direction`)
  hqp::Problem problem({.variables = n_m + 1, .levels = 3, .rows = 6 + n_m + 1});
  problem.clear(n_m + 1);
  Eigen::VectorXd row(n_m + 1);
  const std::span<const double> coefficients(row.data(), row.size());
  problem.add_level();
  for (int i = 0; i < 6; ++i) {
    row << J.row(i).transpose(), i < 3 ? -direction[i] : 0.0;
    problem.add_row(coefficients, {-bias[i], -bias[i]});
  }
  problem.add_level();
  for (int i = 0; i < n_m; ++i) {
    const ActuatorModel& motor = device.motors()[i];
    row << chain.M().row(n_p + i).tail(n_m).transpose(), 0.0;
    row[i] += motor.rotor_inertia;
    const Interval torque = allowed_torque(motor, motion.dq_m[i]);
    problem.add_row(coefficients, {torque.lb - h[i], torque.ub - h[i]}, 1.0 / motor.torque_max);
  }
  problem.add_level();
  problem.add_bound(n_m, {.lb = kBeyond});
  hqp::Solver solver(problem.capacity());
  hqp::Solution solution(problem.capacity());
  hqp::ActiveSet active;
  solver.solve(problem, {}, active, solution);
  const bool holds =
      std::ranges::none_of(std::span(solution.state).subspan(6, n_m), hqp::is_violated);
  const double rated = device.has_rated_accelerations() ? rating(device, direction) : kInfinity;
  return holds ? std::clamp(solution.x[n_m], 0.0, rated) : 0.0;
}

}  // namespace hg::rendering
