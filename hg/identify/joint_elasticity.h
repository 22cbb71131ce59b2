/// Stiffness and damping of an elastic joint from the positions of both of its sides and its
/// torque.
///
/// Model (hg/signals/actuator_model.h), solved for the twist:
///   theta - q = (tau - T tau' + T^2 tau'' - T^3 tau''') / K + o + e(q) + e(N theta),   T = D / K
/// e: errors of the encoders and of the gear once and twice per turn of joint and motor (N, the
/// gear ratio; not with 1), o: their offset. All columns pass the same smoothing. Torque sensors
/// are the more exact side: noise of the encoders does not bias 1/K. Deviations: jackknife over
/// blocks of 1 s, and kTorqueGain, which no motion shows.
///
/// SI units; for a prismatic joint read N for Nm and m for rad.
#pragma once

#include <string>
#include <vector>

#include "hg/identify/figure.h"
#include "hg/identify/joint_recording.h"
#include "hg/signals/actuator_model.h"

namespace hg::identify {

/// Deviation of the gain of joint torque sensors: class of 0.5 %, [A]
inline constexpr double kTorqueGain = 5e-3;

struct JointElasticity {
  Figure stiffness;                  ///< K, Nm/rad
  Figure damping;                    ///< D, Nms/rad
  double torque = 0.0;               ///< rms of the torque about its mean, Nm
  double twist = 0.0;                ///< rms of the twist about its mean, rad
  double residual = 0.0;             ///< rms of the unexplained twist, rad
  std::vector<std::string> missing;  ///< motions needed for the parameters not found
};

/// Identifies joint `joint` of the manipulator; `nominal` gives the values kept where the motion
/// does not show them.
JointElasticity identify_elasticity(const std::vector<JointMotion>& parts, int joint,
                                    double period_s, const ActuatorModel& nominal,
                                    double gear_ratio);

}  // namespace hg::identify
