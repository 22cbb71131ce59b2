#include "hg/simulator/sensors/torque_estimate.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "hg/simulator/random_stream.h"

namespace hg::simulator {

TorqueEstimate::TorqueEstimate(const TorqueEstimateConfig& config, const VectorM& torque_max,
                               std::uint64_t seed)
    : config_(config), torque_max_(torque_max), offset_(torque_max) {
  for (Eigen::Index i = 0; i < offset_.size(); ++i) {
    RandomStream random(seed, RandomEffect::kTorqueEstimate, static_cast<int>(i));
    offset_[i] *= config.offset * random.gaussian();
  }
}

Vector6 TorqueEstimate::error(const JacobianM& J, const VectorM& dq,
                              const VectorM& carrying) const noexcept {
  constexpr double kReversal = 0.02;  // rad/s, over which friction changes its sign
  constexpr double kDamping = 0.05;   // m or 1, smallest singular value that is trusted
  VectorM e = offset_ + config_.weight * carrying;
  for (Eigen::Index i = 0; i < e.size(); ++i) {
    e[i] += config_.friction * torque_max_[i] * std::tanh(dq[i] / kReversal);
  }
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const Matrix6 gram = J.lazyProduct(J.transpose()) + kDamping * kDamping * Matrix6::Identity();
  const Vector6 load = J.lazyProduct(e);
  return gram.llt().solve(load);
}

}  // namespace hg::simulator
