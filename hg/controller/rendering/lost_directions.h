/// Damping of a twin in directions of the handle in which the arm can hardly move.
///
/// Near a singular posture a small velocity of the handle needs a large one of the joints, so that
/// the noise of the force sensor alone would move them. With singular values s of the Jacobian
/// (lengths in m, rotations at 0.3 m), each direction with s < 0.05 is damped by
///   b = 0.1 Nms/rad / (1 + |dq| / 0.1 rad/s) (1 / s^2 - 1 / 0.05^2),  in Ns/m,
/// the friction of a joint with velocity dq = v / s, viscous while it is slow: it grows from zero,
/// dissipates only, and brakes no fast joint hard. Other directions stay as they are.
///
/// With B = sum of b a a^T over these directions, a = J_a^T u, the twin obeys
///   (M_a + dt B) ddq_a = tau - B dq_a + reactions:
/// the damping acts on the velocity at the end of the period, which the reactions of locks, stops
/// and limits take part in. So it is stable however large it is. No allocation, noexcept.
#pragma once

#include "hg/controller/rendering/twin_model.h"
#include "hg/core/types.h"
#include "hg/model/chain_data.h"

namespace hg::rendering {

class LostDirections {
 public:
  /// The directions of this cycle. `J` is the handle's Jacobian by the joints that move it, `J_a`
  /// the end effector's by the twin's degrees of freedom with velocity `dq_a`, M_a = L L^T; `dt` is
  /// the period, s.
  void find(const model::Jacobian& J, const model::Jacobian& J_a, const MatrixA& L,
            const VectorA& dq_a, double dt) noexcept;
  void clear() noexcept { count_ = 0; }
  bool empty() const noexcept { return count_ == 0; }

  /// B dq_a, one entry per degree of freedom.
  VectorA torque(const VectorA& dq_a) const noexcept;
  /// Makes L the factor of M_a + dt B.
  void add_to(MatrixA& L) const noexcept;

 private:
  int count_ = 0;
  double dt_ = 0.0;
  /// Columns sqrt(b) a.
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, kMaxTwin, 6> roots_;
};

}  // namespace hg::rendering
