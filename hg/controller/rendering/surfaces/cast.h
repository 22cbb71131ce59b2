/// First intersection of a straight path with a solid.
///
/// Solids are entered only from outside. Some lengths make the result independent of rounding: a
/// path enters where it gets kEntered deep, it is stopped on the surface itself, and a path that
/// begins less than kOutside deep counts as outside. So a proxy that rests on a surface may glide
/// along it, and is stopped again when it is pushed into it. Solids are enlarged by kGrown, so that
/// there is no gap between two that touch. SI units, frame B. No allocation.
#pragma once

#include <optional>

#include "hg/controller/rendering/surfaces/surface.h"

namespace hg::surfaces {

inline constexpr double kEntered = 1e-10;  ///< m; maximum depth of a proxy
inline constexpr double kGrown = 2e-10;    ///< m; enlargement of solids, more than kEntered
inline constexpr double kOutside = 1e-6;   ///< m; start points less deep count as outside
inline constexpr double kSeam = 1e-7;      ///< overlap of triangles at their edges, m

struct Hit {
  double share = 1.0;      ///< position along the path, 0..1
  Eigen::Vector3d normal;  ///< surface normal at the hit, outwards, unit
};

std::optional<Hit> first_hit(const Surface& surface, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& to) noexcept;

/// Whether a point is inside the solid, deeper than kOutside. An open mesh has no inside.
bool is_inside(const Surface& surface, const Eigen::Vector3d& point) noexcept;

}  // namespace hg::surfaces
