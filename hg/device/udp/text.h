/// Texts in messages.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace hg::udp {

/// Foreign text made safe for a terminal, in one line, by hg/core/visible.h.
std::string printable(std::string_view text);

/// Text of fixed capacity; longer text is cut.
template <std::size_t kSize>
struct Text {
  std::array<char, kSize> bytes{};

  Text() = default;
  template <std::convertible_to<std::string_view> T>
  Text(const T& value) noexcept {  // NOLINT(google-explicit-constructor)
    const std::string_view text = value;
    std::memcpy(bytes.data(), text.data(), std::min(text.size(), kSize));
  }
  /// Text as received; use printable() for display.
  std::string_view view() const noexcept {
    return {bytes.begin(), std::find(bytes.begin(), bytes.end(), '\0')};
  }
  std::string printable() const { return udp::printable(view()); }
};

}  // namespace hg::udp
