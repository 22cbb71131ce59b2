/// Where measurements hold and move the handle of a device.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "hg/config/device.h"
#include "hg/config/simulation/scenario.h"

namespace hg::experiments {

/// Prefix of the reason why a device cannot do a measurement; it is no failure.
inline constexpr const char* kNotPossible = "not possible: ";

/// Part of the workspace in which measurements are made, in B. The defaults are those of the
/// HapticGiant, whose twin starts in the orientation that its own file gives.
struct Place {
  Eigen::Vector3d middle{0.0, 0.0, -0.775};  ///< position at which the handle is held, m
  /// Box of the ends of strokes, m: as large as no limit is felt
  Eigen::Vector3d lower{-1.2, -1.5, -1.05}, upper{1.2, 1.5, -0.55};
  /// Largest turn of the handle about the vertical to either side, rad
  double turn = std::numeric_limits<double>::infinity();
  bool is_found = false;  ///< found for this device; false: that of the HapticGiant
  Eigen::Matrix3d R_B_H = Eigen::Matrix3d::Identity();  ///< orientation, of a found place
  /// Posture of the manipulator in the middle; empty = that nearest to the device's own
  VectorM posture;
};

/// The place of a device: of the HapticGiant a given one. Of any other the box around its posture,
/// or around the best of random postures, in which all corners are reached on straight ways with
/// the handle in one orientation, with a margin to the limits, to singular postures, to the floor
/// and to collisions. Deterministic. Throws SetupError where the device has no such box of 4 cm.
Place place_of(const config::DeviceConfig& device);

/// The scenario with its free body at the place: start and orientation follow from a found place,
/// and remain as they are at a given one; the posture of the device becomes that of the place, if
/// it has one. Throws SetupError unless the twin is a free body.
config::Scenario at_place(config::Scenario scenario, const Place& place);

/// Why a straight way of `length` (m) along `direction`, centred at the middle, does not fit in a
/// found place, with kNotPossible; empty = it fits.
std::string no_room(const Place& place, const Eigen::Vector3d& direction, double length);

/// The place in words, for a report; empty for a given one.
std::string to_text(const Place& place);

}  // namespace hg::experiments
