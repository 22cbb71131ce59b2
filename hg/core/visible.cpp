#include "hg/core/visible.h"

#include <algorithm>
#include <array>
#include <utility>

namespace hg {
namespace {

// ranges (first, last) of hidden characters beyond ASCII
constexpr std::array<std::pair<char32_t, char32_t>, 8> kHidden = {{
    {0x80, 0x9f},        // control characters
    {0x61c, 0x61c},      // directions of writing, here and below
    {0x200e, 0x200f},    //
    {0x2028, 0x202e},    // with the separators of lines
    {0x2066, 0x2069},    //
    {0xfeff, 0xfeff},    // byte order mark
    {0xfff9, 0xfffb},    // annotations
    {0xe0000, 0xe007f},  // tags
}};

struct Character {
  std::size_t bytes = 0;  // 0: no valid UTF-8
  char32_t code = 0;
};

// The first character of `text`, which is not empty.
Character first_character(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return {1, first};
  const std::size_t size = first < 0xc0   ? 0
                           : first < 0xe0 ? 2
                           : first < 0xf0 ? 3
                           : first < 0xf8 ? 4
                                          : 0;
  if (size == 0 || text.size() < size) return {};
  char32_t code = first & (0x7fU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {};
    code = code << 6U | (byte(i) & 0x3fU);
  }
  constexpr std::array<char32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};  // smallest, by bytes
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kLeast[size] || code > 0x10ffff || is_surrogate) return {};
  return {size, code};
}

}  // namespace

std::size_t shown_bytes(std::string_view text) noexcept {
  const auto [bytes, code] = first_character(text);
  if (bytes == 1) return code == '\n' || code == '\t' || (code >= 0x20 && code != 0x7f);
  const bool is_hidden = std::ranges::any_of(kHidden, [code = code](const auto& range) {
    return code >= range.first && code <= range.second;
  });
  return is_hidden ? 0 : bytes;
}

bool is_utf8(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::size_t bytes = first_character(text).bytes;
    if (bytes == 0) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

std::string visible(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const std::size_t bytes = shown_bytes(text);
    if (bytes == 0) {
      const auto first = static_cast<unsigned char>(text[0]);
      shown.append("\\x").append({kDigits[first >> 4U], kDigits[first & 15U]});
    }
    shown += text.substr(0, bytes);
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return shown;
}

}  // namespace hg
