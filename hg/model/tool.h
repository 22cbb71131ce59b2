/// Attaches a tool to a link of a URDF that has been read.
#pragma once

#include "hg/model/chain_model.h"
#include "hg/model/urdf.h"

namespace hg::model {

/// Adds a link `tool.handle`, fixed to `tool.link`, with the tool's mass. Throws SetupError if the
/// URDF has no such link (nearest name), already has the handle, or the mass distribution is
/// physically impossible.
void attach(const Tool& tool, Urdf& urdf);

}  // namespace hg::model
