/// What the refusal of a number adds: the other unit that it may be in.
#pragma once

#include <string>
#include <string_view>

#include "hg/config/schema.h"

namespace hg::config {

/// "; suspected millimetres: 1.65 m" for a number beyond its bounds; empty: nothing is suspected.
std::string suspected_of(double value, std::string_view unit);

/// A position beyond its limits, as text, with the degrees that it may be in.
std::string with_suspected_degrees(double position, const limits::JointLimits& limits,
                                   JointUnit unit);

}  // namespace hg::config
