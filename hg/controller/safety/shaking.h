/// Detects shaking of hand and device that passivity/ does not cover: torques, forces and torques
/// above 30 Hz, and repeated bouncing off virtual surfaces.
///
/// - Torque, 3 to 30 Hz: method of passivity/ for the user's torque: more than 0.1 Nm
///   rms, and more than half of what is below 3 Hz and 0.05 Nm, for 0.2 s and three turns.
/// - Above 30 Hz (as far as the sensor shows; below half of the rate): what the sensor itself
///   measures, with the inertia of the handle, since a hand yields to such motion without force.
///   More than 1 N or 0.1 Nm rms over 50 ms, for 0.5 s: an impact rings for less.
/// - Bouncing: at least the third contact in a row with 2.5 s between them at most, met with half
///   the speed of the first or more, while the handle has given the person more energy than the
///   body had at the first, and 0.5 J. A tapping person gives energy and takes none.
///
/// Every index is 1 from detection on. Pure function of its arguments and the state: no allocation,
/// noexcept.
#pragma once

#include "hg/core/turns.h"
#include "hg/core/types.h"
#include "hg/signals/fault.h"

namespace hg::safety {

struct ShakingState {
  bool is_started = false;
  // torque up to 30 Hz
  Eigen::Vector3d x1 = Eigen::Vector3d::Zero(), x2 = Eigen::Vector3d::Zero(),
                  x3 = Eigen::Vector3d::Zero();
  double high = 0.0, low = 0.0;  ///< Mean squares of high and low band, (Nm)^2
  Turns turns;
  // above 30 Hz: last inputs and outputs of a high-pass
  Vector6 in1 = Vector6::Zero(), in2 = Vector6::Zero(), out1 = Vector6::Zero(),
          out2 = Vector6::Zero();
  double force = 0.0, torque = 0.0;  ///< Mean squares above 30 Hz, N^2 and (Nm)^2
  double torque_s = 0.0, fast_force_s = 0.0, fast_torque_s = 0.0;  ///< Detection counters, s
  // bouncing
  bool touches = false;
  int contacts = 0;              ///< Consecutive contacts
  double since_contact_s = 0.0;  ///< Time since the last contact began, s
  double first_speed = 0.0;      ///< Approach speed of the first contact, m/s
  double given = 0.0;            ///< Energy given to the person since the first contact, J
  bool bounces = false;          ///< Bouncing has been detected since the last contact
  double shakes_s = 0.0;         ///< Time for which anything has been detected, s
};

/// Inputs of one cycle in which the twin is rendered.
struct ShakingInput {
  const Vector6& w_S;                    ///< Wrench that the sensor measures, in its own frame
  const Vector6& w_H;                    ///< Wrench of the user on the handle
  const Eigen::Vector3d& v_H;            ///< Velocity of the handle, m/s
  const Eigen::Vector3d& contact_force;  ///< Force of virtual surfaces on the handle, N
  double oscillation = 0.0;              ///< PassivityReport::oscillation
};

struct ShakingReport {
  Shaking what = Shaking::kNone;  ///< Detected kind with the largest index, or kNone
  double index = 0.0;             ///< Index of that kind; 1 = detected
};

class ShakingWatch {
 public:
  /// `mass`: largest mass of the twin felt at the handle, kg.
  ShakingWatch(double dt, double mass) noexcept;

  /// Advances by one sample; call once per cycle in which the twin is rendered.
  ShakingReport step(const ShakingInput& input, ShakingState& state) const noexcept;

 private:
  double check_torque(const Eigen::Vector3d& torque, ShakingState& state) const noexcept;
  void look_above(const Vector6& w_S, ShakingState& state) const noexcept;
  double look_for_bouncing(const ShakingInput& input, ShakingState& state) const noexcept;

  double dt_, mass_;
  double b_, a1_, a2_;  ///< Coefficients of the high-pass, Butterworth of second order
};

}  // namespace hg::safety
