/// Inertial parameters of a device's links from joint torques, motion and the wrench at the sensor.
///
/// Model, with the files' inverse dynamics ID and errors dp of the links' parameters:
///   tau - ID - W w = Y dp - W b + o + v q' + f tanh(q' / v_0) + r(N theta) + G
/// Y: regressor of the links, W = -J^T of the sensor, w: its reading less the payload, b: what is
/// left of its offset; o, v, f: offset of each torque sensor and friction that it feels; r: ripple
/// once and twice per turn of the motor; G: gains of the torque sensors, gains, cross-talk and
/// delay of the force/torque sensor, with a prior. All signals pass the same smoothing. Least
/// squares in the base parameters C dp, weighted by joint; deviations: jackknife over blocks of 1
/// s. Then the consistent parameters that are nearest to both recording and URDF
/// (pseudo_inertia.h).
///
/// SI units.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hg/identify/figure.h"
#include "hg/identify/inertia_model.h"
#include "hg/identify/joint_recording.h"

namespace hg::identify {

/// A combination of parameters that shows in the torques.
struct BaseFigure {
  std::string name;
  double nominal = 0.0;
  Figure found;  ///< is_found: the recording narrows what the URDF leaves open to less than half
};

/// m, c_x, c_y, c_z, then about the centre of mass I_xx, I_xy, I_yy, I_xz, I_yz, I_zz.
inline constexpr int kLinkFigures = 10;

struct LinkInertia {
  std::string name;
  model::Inertial nominal, found;
  std::array<double, kLinkFigures> nominal_values{};
  std::array<Figure, kLinkFigures> figures;  ///< is_found as for BaseFigure
};

struct JointFit {
  std::string name;
  double before = 0.0, after = 0.0;  ///< rms of the unexplained torque by the files and now, Nm
  double way = 0.0;                  ///< from the least to the largest position, rad
  double acceleration = 0.0;         ///< rms, rad/s^2
};

struct InertiaEstimate {
  std::vector<JointFit> joints;
  std::vector<BaseFigure> base;
  std::vector<LinkInertia> links;
  int shown = 0;        ///< number of base parameters that are found
  std::string missing;  ///< one sentence: what the recording lacks; empty = enough
};

/// Identifies the links of `device`.
InertiaEstimate identify_inertia(const std::vector<JointMotion>& parts,
                                 const config::SimulatedDeviceConfig& device);

struct RecordedInertia {
  std::vector<recording::Loss> losses;  ///< damaged parts of the recording
  double used_s = 0.0;                  ///< time with the drives on, s
  InertiaEstimate found;
};

/// The same from a recording; `device` empty = the one that it was made with. Throws SetupError,
/// also where it has no joint torques.
RecordedInertia identify_recorded_inertia(const std::string& file,
                                          std::optional<config::SimulatedDeviceConfig> device);

}  // namespace hg::identify
