/// Damping and inertia that the energy monitor adds to the twin, and the law renders.
#pragma once

namespace hg {

struct AddedImpedance {
  double damping = 0.0;  ///< Damping at the end effector, in all directions, Ns/m
  double inertia = 1.0;  ///< Factor of the twin's inertia, without more weight, >= 1
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const AddedImpedance& added) {
  const auto& [damping, inertia] = added;
  hash.mix(damping, inertia);
}

}  // namespace hg
