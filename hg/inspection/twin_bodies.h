/// Mass distributions of a URDF that a body could have, but hardly the one that is meant: values in
/// mm, g or with a point lost.
#pragma once

#include <vector>

#include "hg/inspection/findings.h"

namespace hg::inspection {

void inspect_bodies(const std::vector<config::SourceText>& sources, Collector& out);

}  // namespace hg::inspection
