/// Torques that lead a Franka along the reference of the law: its drives take torques, our drives
/// follow positions.
///
///     tau = M(q) ddq_r + c(q, dq) + K (q_r - q) + D (dq_r - dq)
///
/// c without gravity, which the robot adds itself. Differs from libfranka's example
/// joint_impedance_control by M ddq_r and by damping around the speed of the reference. The user's
/// wrench is not fed forward: it is an estimate from the same torques, which would close a loop of
/// its own. So a hand bends the arm away from the reference by J^T w / K.
#pragma once

#include "hg/core/types.h"
#include "hg/model/chain_data.h"
#include "hg/signals/frames.h"

namespace hg::franka {

/// Stiffness and damping, one value per joint.
struct ImpedanceGains {
  // those of libfranka's examples/joint_impedance_control.cpp
  VectorM stiffness = VectorM{{600, 600, 600, 600, 250, 150, 50}};  ///< Nm/rad
  VectorM damping = VectorM{{50, 50, 50, 50, 30, 25, 15}};          ///< Nms/rad
};

class Impedance {
 public:
  /// `chain` has the joints of the arm and its tool.
  Impedance(const model::ChainModel& chain, const ImpedanceGains& gains);

  /// Torques beyond gravity, Nm. No allocation.
  VectorM torques(const CommandFrame& command, const VectorM& q, const VectorM& dq) noexcept;
  /// Torques that hold the arm against its weight, Nm; set-up only.
  VectorM weight(const VectorM& q) noexcept;
  /// Largest torques of the joints, Nm.
  const VectorM& torque_max() const noexcept { return torque_max_; }

 private:
  model::ChainData chain_;
  ImpedanceGains gains_;
  VectorM torque_max_;
};

/// Torques that come nearer to `wanted` by no more than the robot allows in one period (1000 Nm/s).
VectorM rate_limited(const VectorM& wanted, const VectorM& last) noexcept;

}  // namespace hg::franka
