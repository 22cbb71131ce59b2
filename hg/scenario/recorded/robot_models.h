/// Device and twin as tools draw them: robot models by URDF, and the frames that move them.
#pragma once

#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/messages/run_names.h"

namespace hg::scenario {

/// The links of both chains, as measured, each in its parent by the URDF; those of the twin are
/// called twin/NAME. A link is in "base" where it has no parent, or where its parent is called like
/// a frame that the messages have anyway (handle, elbow); links of these names are left out. The
/// result owns copies of the models; one thread.
messages::LinkTree link_tree(const config::Scenario& scenario);

/// URDF of the device.
std::string device_description(const config::Scenario& scenario);
/// URDF of the twin, whose links are called twin/NAME; empty for a free body.
std::string twin_description(const config::Scenario& scenario);

}  // namespace hg::scenario
