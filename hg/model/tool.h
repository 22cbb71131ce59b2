/// Screws a tool onto a link of a URDF that has been read.
#pragma once

#include "hg/model/chain.h"
#include "hg/model/urdf.h"

namespace hg::model {

/// Adds a link `tool.handle`, fixed to `tool.link`, that has the tool's mass. Throws SetupError
/// when the URDF has no such link (nearest name), when it has the handle already, or when no body
/// has that mass distribution.
void attach(const Tool& tool, Urdf& urdf);

}  // namespace hg::model
