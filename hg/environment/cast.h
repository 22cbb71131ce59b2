/// Where a straight way first enters a solid.
///
/// Solids are entered only from outside. Some lengths keep rounding from deciding: a way enters
/// where it gets kEntered deep, it is stopped on the surface itself, and what begins less than
/// kOutside deep counts as outside. So a proxy that rests on a surface may glide along it, and is
/// stopped again when it is pushed into it. Solids are larger than they are said to be by kGrown,
/// so that nothing falls between two that touch. SI units, frame B. No allocation.
#pragma once

#include <optional>

#include "hg/environment/surface.h"

namespace hg::environment {

inline constexpr double kEntered = 1e-10;  ///< m; a proxy is never deeper
inline constexpr double kGrown = 2e-10;    ///< m; more than kEntered
inline constexpr double kOutside = 1e-6;   ///< m
inline constexpr double kSeam = 1e-7;      ///< by which triangles overlap at their edges, m

struct Hit {
  double share = 1.0;      ///< of the way, 0..1
  Eigen::Vector3d normal;  ///< of the surface there, outwards, unit
};

std::optional<Hit> first_hit(const Surface& surface, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& to) noexcept;

/// Whether a point is in the solid, deeper than kOutside. A mesh that is not closed has no inside.
bool is_inside(const Surface& surface, const Eigen::Vector3d& point) noexcept;

}  // namespace hg::environment
