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

/// What such drives make of their commands. A command asks for q, dq, ddq one period after its
/// arrival. Without a successor it continues with its acceleration; the difference to the one that
/// then comes vanishes within kCatchUp_s, so that neither steps the joints.
class DriveInterpolator {
 public:
  static constexpr double kCatchUp_s = 0.1;

  DriveInterpolator() = default;
  /// `period`: between two commands, s.
  explicit DriveInterpolator(double period) noexcept : period_(period) {}

  /// A command arrives; advance() has been called up to now.
  void take(const DriveReference& command) noexcept;
  /// Reference after another `step`, s.
  DriveReference advance(double step) noexcept;
  /// Without power: the next command is taken as it is.
  void rest() noexcept { *this = DriveInterpolator(period_); }
  bool has_command() const noexcept { return command_.q.size() > 0; }

 private:
  DriveReference commanded() const noexcept;
  DriveReference present() const noexcept;

  double period_ = 0.0;
  double age_ = 0.0;        // of the command, s
  double since_ = 0.0;      // of the end of the last gap, s
  DriveReference command_;  // empty: none has come
  DriveReference gap_;      // difference at the end of the last gap; empty: none
};

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
