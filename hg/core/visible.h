/// Makes untrusted text (titles, names, recordings, the network) safe to show: escapes everything
/// that a terminal or page would interpret instead of display.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hg {

/// Number of bytes of the first character of `text` (not empty) if it may be shown unchanged; 0: it
/// must be escaped. Escaped are control characters other than line feed and tab, line separators,
/// marks of writing direction (U+202E), and invalid or overlong UTF-8 (C0 9B).
std::size_t shown_bytes(std::string_view text) noexcept;

/// Whether all of `text` is valid UTF-8, control characters included.
bool is_utf8(std::string_view text) noexcept;

/// `text` with the bytes of all characters that must not be shown as escapes such as \x1b.
std::string visible(std::string_view text);

}  // namespace hg
