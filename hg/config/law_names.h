/// Names of law, bounds, gantry guidance, braking before limits, and passivity reaction, in
/// device.yaml and on the command line.
#pragma once

#include "hg/config/schema.h"
#include "hg/controller/rendering/options.h"
#include "hg/controller/safety/passivity/passivity.h"

namespace hg::config {

inline constexpr auto kLaws = choices_of<rendering::Law>();
inline constexpr auto kBounds = choices_of<rendering::Bounds>();
inline constexpr auto kGantries = choices_of<rendering::Gantry>();
inline constexpr auto kBrakings = choices_of<rendering::Braking>();
inline constexpr auto kPassivityReactions = choices_of<passivity::Reaction>();

}  // namespace hg::config
