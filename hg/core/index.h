/// Index of a standard container from a signed number.
#pragma once

#include <cstddef>

namespace hg {

/// `i` as an index; i >= 0.
constexpr std::size_t index(std::ptrdiff_t i) noexcept { return static_cast<std::size_t>(i); }

}  // namespace hg
