/// Index of an array with one element per enumerator.
#pragma once

#include <cstddef>
#include <type_traits>

namespace hg {

/// The number of an enumerator; it is >= 0. Signed numbers index containers as they are.
template <typename T>
requires std::is_enum_v<T>
constexpr std::size_t index(T enumerator) noexcept { return static_cast<std::size_t>(enumerator); }

}  // namespace hg
