#include "hg/controller/rendering/constraint_directions.h"

namespace hg::rendering {

ConstraintDirections::ConstraintDirections(const DeviceModel& device, const TwinModel& twin)
    : n_p_(device.n_p),
      n_m_(device.n_m),
      J_m_(6, n_m_),
      J_m_T_(n_m_, 6),
      J_a_(6, twin.chain.nv()),
      wrench_(6, device.limit_count()),
      torque_(twin.chain.nv(), device.limit_count()),
      idle_(VectorUpTo<kMaxLimits>::Zero(device.limit_count())) {}

void ConstraintDirections::update(const model::Jacobian& J_H, const model::Jacobian& J_a) noexcept {
  J_m_ = J_H.middleCols(n_p_, n_m_);
  J_a_ = J_a;
  is_factored_ = false;
}

void ConstraintDirections::find(const hqp::Problem& problem, int row, int limit) noexcept {
  if (!is_factored_) J_m_T_.compute(J_m_.transpose());
  is_factored_ = true;
  VectorM C = VectorM::Zero(n_m_);
  const int joint = problem.variable(row);
  if (joint >= 0) {
    C[joint] = 1.0;
  } else {
    C = Eigen::Map<const Eigen::VectorXd>(problem.coefficients(row).data(), n_m_);
  }
  wrench_.col(limit) = J_m_T_.solve(C);
  torque_.col(limit).noalias() = J_a_.transpose() * wrench_.col(limit);
  if (n_m_ > 6) {
    C.applyOnTheLeft(J_m_T_.householderQ().adjoint());
    idle_[limit] = C[6];
  }
}

}  // namespace hg::rendering
