/// Suggests the valid name that a wrong one probably meant, for messages of SetupError.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace hg {

/// Candidate with the smallest edit distance to `name`, ignoring case; on a tie the first; empty
/// without candidates. Those with more than 200 letters are left out.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// Candidate that `name` misspells: one wrong letter, or two from six letters on, or another case;
/// empty if there is none, or if `name` is a candidate itself.
std::string misspelt_name(std::string_view name, std::span<const std::string> candidates);

}  // namespace hg
