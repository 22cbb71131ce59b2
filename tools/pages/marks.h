/// Generated parts of a page that is otherwise written by hand.
#pragma once

#include <string>
#include <string_view>

namespace hg::pages {

/// Replaces what stands between `<!-- NAME -->` and the next `<!-- end -->` by `text`. Throws
/// SetupError where the page has no such marks.
void replace_marked(std::string& page, std::string_view name, std::string_view text);

}  // namespace hg::pages
