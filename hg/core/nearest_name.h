/// Suggests the valid name that a wrong one probably meant, for messages of SetupError.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace hg {

/// The candidate with the smallest edit distance to `name`, upper and lower case alike; the first
/// of equals; empty if there is no candidate.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

}  // namespace hg
