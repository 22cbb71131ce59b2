/// The controller inside drives that follow positions: a position loop around a speed loop, on the
/// motor side of every joint.
///
///   v   = dq_r + w_q (q_r - theta)
///   tau = tau_known + J (ddq_r + w_v (v - theta') + w_v^2 / 10 integral of (v - theta'))
/// J is the inertia of the axis as it moves alone, tau_known the torque that carries the arm.
/// SI units. Copyable; no allocation, noexcept.
#pragma once

#include "hg/core/types.h"

namespace hg::simulator {

/// Set-up data; bandwidths of the two loops, Hz, > 0.
struct PositionLoopConfig {
  double position_Hz = 10.0;  ///< w_q / 2 pi: how fast an error of the position vanishes
  double speed_Hz = 50.0;     ///< w_v / 2 pi
};

/// What the drives follow at one moment; one entry per manipulator joint.
struct DriveReference {
  VectorM q, dq, ddq;
};

/// Reference at `age` (s) after the arrival of a command that asks for q, dq, ddq one `period` (s)
/// after it. A command that has no successor ends there.
DriveReference interpolated(const DriveReference& command, double age, double period) noexcept;

class PositionLoop {
 public:
  PositionLoop() = default;
  /// `step`: time between two calls of torque(), s.
  PositionLoop(const PositionLoopConfig& config, double step) noexcept;

  /// Motor torques, Nm; each within its `torque_max`.
  VectorM torque(const DriveReference& reference, const VectorM& theta, const VectorM& dtheta,
                 const VectorM& inertia, const VectorM& tau_known,
                 const VectorM& torque_max) noexcept;
  /// Without power: forgets what was integrated.
  void rest() noexcept { integral_.setZero(); }

 private:
  double w_q_ = 0.0, w_v_ = 0.0, step_ = 0.0;
  VectorM integral_;  // of the error of the speed, rad
};

}  // namespace hg::simulator
