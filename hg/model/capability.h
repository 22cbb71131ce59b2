/// Guaranteed force, torque and acceleration at the handle in one posture, in closed form.
///
/// Source: [HANDBOOK] 8.4. With column i of the Jacobian (linear part Jt_i, angular part Jr_i), the
/// joint torque t_i available beside gravity holds a force F in every direction if F |Jt_i| <= t_i,
/// and a torque N if N |Jr_i| <= t_i. SI units, frame B.
#pragma once

#include <Eigen/Core>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/model/chain_data.h"

namespace hg::model {

/// Smallest over all directions of the largest force (N), torque (Nm) or acceleration (m/s^2).
struct Guarantee {
  double value = kInfinity;
  int joint = -1;  ///< limiting joint: column of the Jacobian; -1 = none
};

/// Computes min_i available_i / |column i|; columns of length 0 do not limit. `columns` are three
/// rows of a Jacobian; `available` may be infinite, below zero counts as zero.
Guarantee worst_direction(const Eigen::Ref<const Eigen::Matrix3Xd>& columns,
                          const Eigen::Ref<const Eigen::VectorXd>& available);

/// Acceleration of the handle's origin, without angular acceleration, available in every direction
/// with joint accelerations up to ddq_max; zero where J has not full rank.
Guarantee worst_acceleration(const Jacobian& J, const Eigen::Ref<const Eigen::VectorXd>& ddq_max);

/// Force and torque at the handle that the HapticGiant provides in any direction, [HG] III-B.
inline constexpr double kPaperForce = 50.0, kPaperTorque = 10.0;  // N, Nm

/// Whether a force (N) and a torque (Nm) can be held at once, in any directions.
bool holds_wrench(const Jacobian& J, const Eigen::Ref<const Eigen::VectorXd>& available,
                  double force, double torque);

struct Conditioning {
  double smallest = 0.0;   ///< smallest singular value of the scaled Jacobian
  double condition = 0.0;  ///< largest / smallest singular value
};

/// Conditioning of J with its linear rows divided by `length` in m, so that all rows are rad.
Conditioning conditioning(const Jacobian& J, double length);

}  // namespace hg::model
