#include "hg/controller/rendering/holding.h"

namespace hg::rendering {
namespace {

constexpr double kStep = 1e-4;  // rad or m, of the difference

}  // namespace

Holding::Holding(const DeviceModel& device)
    : n_p_(device.n_p),
      n_m_(device.n_m),
      chain_(device.chain),
      still_(VectorPM::Zero(n_p_ + n_m_)) {}

VectorM Holding::gradient(const VectorPM& q, const model::ChainData& now, int joint) noexcept {
  VectorPM moved = q;
  moved[n_p_ + joint] += kStep;
  const VectorA there = chain_.inverse_dynamics(moved, still_, still_);
  return (there.tail(n_m_) - now.gravity().tail(n_m_)) / kStep;
}

}  // namespace hg::rendering
