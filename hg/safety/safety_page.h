/// The tables of docs/safety.md, made from rules.h and transitions.h.
#pragma once

#include <string>

namespace hg::safety {

/// `page` with what stands between the marks `<!-- NAME -->` and `<!-- end -->` made anew, for the
/// names transitions, rules and stops.
std::string with_tables(std::string page);

}  // namespace hg::safety
