/// Paths of people through a target environment, as they were recorded or made.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/walking/rectangle.h"

namespace hg::walking {

inline constexpr double kWalkPeriod = 1.0 / 60.0;  ///< Between samples of a path, s

struct WalkSample {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();  ///< Position of the person, m
  double heading = 0.0;                         ///< Direction that the person faces, rad
  /// Of p, through two low-pass filters of 50 ms one after the other, m/s
  Eigen::Vector2d v = Eigen::Vector2d::Zero();
};

struct WalkedPath {
  std::string name;
  std::vector<WalkSample> samples;  ///< at least one, every kWalkPeriod
  std::vector<Rectangle> spaces;    ///< where a person can be
};

/// Fills in the velocities.
void add_velocities(std::vector<WalkSample>& samples);
/// The bounding rectangle of the positions and 0.5 m.
Rectangle surroundings(const std::vector<WalkSample>& samples);

/// Reads interval_s, x_m, y_m: the time since the last row and the position; also compressed by
/// gzip. A person faces where the velocity points, and keeps that direction when slower than
/// 0.15 m/s. The space is surroundings(). Throws InputError with file and line.
WalkedPath read_walked_path(const std::string& file);

/// Reads all .csv and .csv.gz files of a folder, in the order of their names. Throws InputError.
std::vector<WalkedPath> read_walked_paths(const std::string& folder);

}  // namespace hg::walking
