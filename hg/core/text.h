/// Small pieces of text for messages and files. Set-up code: allocates.
#pragma once

#include <string>
#include <string_view>

namespace hg {

/// The text in single quotes.
std::string in_quotes(std::string_view text);

/// The shortest decimal number that reads back to the same value.
std::string to_text(double value);

/// The number with at most this many significant digits, as printf("%g") writes it:
/// 0.0123, 1.2e-05.
std::string to_text(double value, int digits);

}  // namespace hg
