/// Implausible mass distributions of a URDF: physically possible, but probably values in mm, g or
/// with a lost decimal point.
#pragma once

#include <vector>

#include "hg/check/findings.h"

namespace hg::check {

void inspect_bodies(const std::vector<config::SourceText>& sources, Collector& out);

}  // namespace hg::check
