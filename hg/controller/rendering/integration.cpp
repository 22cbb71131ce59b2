#include "hg/controller/rendering/integration.h"

namespace hg::rendering {

void integrate(ReferenceState& reference, double dt) noexcept {
  reference.q_m += dt * reference.dq_m + (0.5 * dt * dt) * reference.ddq_m;
  reference.dq_m += dt * reference.ddq_m;
}

void integrate(const model::ChainModel& chain, TwinState& twin, double dt) noexcept {
  const VectorA step = dt * twin.dq_a + (0.5 * dt * dt) * twin.ddq_a;
  twin.q_a = chain.integrate(twin.q_a, step);
  twin.dq_a += dt * twin.ddq_a;
}

}  // namespace hg::rendering
