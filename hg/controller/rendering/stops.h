/// Virtual surfaces that are stops, as rows of the law: what the twin must not move into them.
///
/// The end effector E and spheres fixed to links of the twin meet such surfaces. For each plane in
/// front of one of them a row says how its distance changes, d'' = row ddq_a + bias. SI units.
#pragma once

#include <array>

#include "hg/controller/rendering/surfaces/environment.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/model/chain_data.h"

namespace hg::rendering {

/// Rows of E and of all spheres
inline constexpr int kMostStops = (1 + kMaxSpheres) * surfaces::kMostFacing;

/// A point of the twin in front of a stop.
struct Stop {
  int surface = -1;  ///< Index of the surface; -1: none, all else is unused
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Outward normal of the surface, unit
  double distance = kInfinity;                       ///< Along the normal, m; negative inside
  double speed = 0.0;                                ///< Away from the surface, m/s
  VectorA row;                                       ///< Speed per joint speed of the twin
  double bias = 0.0;                                 ///< Acceleration at ddq_a = 0, m/s^2
  double rating = kInfinity;                         ///< Acceleration with which it brakes, m/s^2
};

/// A twin in a cycle.
struct TwinNow {
  const TwinModel& model;
  const model::ChainData& chain;  ///< after update()
  const MatrixA& L;               ///< M_a = L L^T
  const VectorA& dq;              ///< Joint velocity
  const VectorA& ddq_max;         ///< Acceleration with which each joint brakes
};

/// kMostFacing stops of E, then as many of each sphere, in the order of TwinModel::spheres.
using Stops = std::array<Stop, kMostStops>;

/// Number of stops that can act: none without surfaces that are stops.
int stop_count(const surfaces::Environment& environment, const TwinModel& twin) noexcept;

/// The stops of a twin whose end effector brakes with at most `rating` (m/s^2) along each axis of
/// B. A point brakes as hard as the end effector, which follows it, and the joints together can.
Stops find_stops(const surfaces::Environment& environment, const TwinNow& twin,
                 double rating) noexcept;

}  // namespace hg::rendering
