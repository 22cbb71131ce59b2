/// Something touches the arm: is it felt, and how does the arm give way?
///
/// Detection: the torque of the joints that neither motion nor user explain, M ddq + c - J^T w -
/// tau_J with measured speeds, low-passed. With ddq as their difference this is the observer of the
/// generalised momentum of De Luca et al. (IROS 2006), discrete, gain 1 / filter. A threshold is
/// the sum of a least one, of six standard deviations of the noise while nothing touches, and of a
/// share of what the joint has just been moved with, since that is what the model is wrong by.
///
/// Giving way: of the torques, what is beyond the thresholds becomes the wrench on the handle that
/// does the same to the joints, by damped least squares. It pushes the twin, which yields where it
/// is free; the gantry moves away from the contact.
///
/// Pure functions of arguments and state: deterministic, no allocation, noexcept.
#pragma once

#include "hg/core/types.h"
#include "hg/signals/touch.h"

namespace hg::compliance {

/// Set-up data.
struct Config {
  bool is_on = false;
  double dt = 1e-3;    ///< period, s
  VectorM torque_max;  ///< peak of each joint, Nm; empty: the joints have no torque sensors
};

/// The wrench with which the twin gives way is never larger than this.
inline constexpr double kForceMax = 100.0;   // N
inline constexpr double kMomentMax = 30.0;   // Nm
inline constexpr double kGantrySpeed = 0.3;  // m/s or rad/s, away from the contact

/// Part of the copyable state of a cycle.
struct State {
  bool is_started = false;
  VectorM dq;        ///< of the joints in the last sample, rad/s
  VectorM torque;    ///< by what touches the arm, Nm
  VectorM variance;  ///< of it while nothing touches, Nm^2
  VectorM load;      ///< with which the joints have just been moved, Nm
  bool is_told = false;
  double quiet_s = 0.0;  ///< since when less than half of the thresholds is felt
  VectorP away;          ///< velocity of the gantry, m/s or rad/s; empty: its own aim
};

using JacobianIn = Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>;

/// One sample.
struct Input {
  VectorM torque;  ///< that neither motion nor user explain, Nm
  VectorM load;    ///< that moves and holds the joints by the model, Nm
  JacobianIn J;    ///< of the handle; gantry joints first
  int n_p = 0;     ///< of these
};

/// Once per cycle with the drives on.
TouchReport step(const Config& config, const Input& input, State& state) noexcept;

/// Torque from which a joint feels a contact, Nm.
double threshold(const Config& config, const State& state, int joint) noexcept;

}  // namespace hg::compliance
