/// Global free-space forces and vibrations: a hand leads a free body slowly through the workspace.
///
/// The one definition of force, added force, vibration and centroid in free space.
/// Source: [HANDBOOK] 7. Measures the true force of the person and the true acceleration of the
/// handle.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "hg/config/simulation/scenario.h"
#include "hg/config/twin.h"
#include "hg/experiments/haptify/measures.h"
#include "hg/experiments/haptify/play.h"

namespace hg::haptify {

struct FreeSpaceConfig {
  double duration_s = 60.0;
  double settling_s = 2.0;  ///< time after the grasp that does not count, s
  /// Mean speeds of strokes from place to place, m/s: with minimum-jerk ramps about 0.2 rms.
  double slowest = 0.12, fastest = 0.24;
  /// Box of the stroke ends, m in B: as large as no limit is felt.
  Eigen::Vector3d lower{-1.2, -1.5, -1.05}, upper{1.2, 1.5, -0.55};
  double turn = 0.6;              ///< largest change of the hand's azimuth per stroke, rad
  double turn_range = kInfinity;  ///< largest turn from the start to either side, rad
};

/// Script of random strokes from `start`: other places, speeds and azimuths with every seed.
person::Script exploration(const FreeSpaceConfig& config, const config::HandPose& start,
                           std::uint64_t seed);

struct FreeSpace {
  double force = 0.0;          ///< mean |f|, N
  double own_share = 0.0;      ///< mean |m a + b v|: share of the rendered body itself, N
  double extra = 0.0;          ///< mean |f - (m a + b v)|: share added by the device, N
  double speed_rms = 0.0;      ///< m/s
  double vibration_rms = 0.0;  ///< m/s^2
  double centroid_Hz = 0.0;
  std::array<double, kBandEdges.size() - 1> band_rms{};  ///< m/s^2
  double acceleration_5Hz = 0.0;  ///< rms of the acceleration above 5 Hz, m/s^2
  Spectrum spectrum;              ///< spectrum of the vibration, m/s^2/sqrt(Hz)
  /// Rms vibration as measured by an accelerometer like the device's own, m/s^2
  double seen_rms = 0.0;
  double seen_centroid_Hz = 0.0;
  double limited_share = 0.0;  ///< share of the time in which a limit was felt
  double path = 0.0;           ///< length of the path, m
  double distance_rms = 0.0;   ///< rms distance of the true handle from the twin, m
  double joint_error = 0.0;    ///< largest difference of reference and true link, rad or m
  double torque_share = 0.0;   ///< largest motor torque over its peak
  std::string failure;
};

/// Measures free-space forces and vibrations. Throws SetupError unless the twin of `scenario` is a
/// free body.
FreeSpace measure_free_space(const config::Scenario& scenario, const FreeSpaceConfig& config,
                             std::uint64_t seed, const Disturbance& disturbance = {});

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FreeSpace, force, own_share, extra, speed_rms, vibration_rms,
                                   centroid_Hz, band_rms, acceleration_5Hz, spectrum, seen_rms,
                                   seen_centroid_Hz, limited_share, path, distance_rms, joint_error,
                                   torque_share, failure)

}  // namespace hg::haptify
