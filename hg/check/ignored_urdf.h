/// Names what a URDF says and no part reads.
#pragma once

#include <vector>

#include "hg/check/findings.h"

namespace hg::check {

/// Whose URDF it is: a twin takes damping and friction from it, a device does not.
enum class UrdfUse { kDevice, kTwin };

/// Adds one note per URDF among `sources` that lists the elements and attributes that are not read.
void inspect_ignored(const std::vector<config::SourceText>& sources, UrdfUse use, Collector& out);

}  // namespace hg::check
