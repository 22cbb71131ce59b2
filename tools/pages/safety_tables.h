/// Generates the tables of docs/concepts/safety.md from rules.h and transitions.h.
#pragma once

#include <string>

namespace hg::pages {

/// Returns `page` with the text between the marks `<!-- NAME -->` and `<!-- end -->` regenerated,
/// for the names transitions, rules and stops.
std::string with_safety_tables(std::string page);

}  // namespace hg::pages
