/// Text from elsewhere (titles, names, recordings, the network) as people may be shown it: it says
/// nothing to a terminal or a page but what it looks like.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hg {

/// How many bytes of `text`, which is not empty, are one character that is shown as it is; 0: its
/// first byte begins none. None are control characters but line feed and tab, line separators, what
/// turns the direction of writing (U+202E), and what is no UTF-8 in its shortest form (C0 9B).
std::size_t shown_bytes(std::string_view text) noexcept;

/// `text` with the bytes of everything that is not shown as escapes such as \x1b.
std::string visible(std::string_view text);

}  // namespace hg
