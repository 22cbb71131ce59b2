/// Implausible mass distributions of a URDF: physically possible, but probably values in mm, g or
/// with a lost decimal point.
#pragma once

#include <string>
#include <vector>

#include "hg/check/findings.h"
#include "hg/core/interval.h"

namespace hg::check {

/// Mean moments of inertia that a body of this mass may have, kg m^2: from a ball of tungsten to
/// masses at the distance `reach`, m.
Interval moments_of(double mass, double reach);

/// Of placeholders only the links that joints with these names move count; without names all.
void inspect_bodies(const std::vector<config::SourceText>& sources,
                    const std::vector<std::string>& joints, Collector& out);

}  // namespace hg::check
