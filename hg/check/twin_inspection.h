/// Faults and notable properties of a twin: mass matrix, inertia, limits, springs, dampers.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/check/findings.h"
#include "hg/config/twin.h"

namespace hg::check {

/// Coordinates drawn within the limits of the twin, unlimited joints in model::finite_range;
/// floating joints stay where they start. The start comes first.
std::vector<ConfigurationA> twin_postures(const config::Twin& twin, int count, std::uint64_t seed);

/// Extremes over postures of a twin.
struct TwinFigures {
  double condition = 1.0;      ///< largest condition number of the mass matrix
  double mass = kInfinity;     ///< smallest mass felt by the hand in any direction, kg
  double inertia = kInfinity;  ///< smallest inertia felt by the hand about any axis, kg m^2
  VectorA smallest_inertia;    ///< smallest 1 / (M^-1)_ii per degree of freedom, kg m^2 or kg
};
TwinFigures twin_figures(const config::Twin& twin, const std::vector<ConfigurationA>& postures);

/// Inspects a twin; `dt` in s is the period of the device that will render it.
Findings inspect(const config::Twin& twin, double dt);

}  // namespace hg::check
