/// What a message between program and page is: a name and a function fields(archive, message) that
/// shows its fields to an archive, in their order. JSON, its reading, and viewer/src/messages.ts
/// all come from that one function.
///
/// For each field the function calls archive(name, value, note); a message of a socket begins with
/// archive.type(word). Values: double, bool, std::string, Vec3, Quaternion, words, other messages,
/// and std::vector or std::optional of these. A number that is not finite is null in JSON.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>

namespace hg::viewer_server {

using Vec3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  ///< x y z w

/// Name of a message's interface in TypeScript, and one line about it.
struct Interface {
  std::string_view name;
  std::string_view note;
};
template <typename Message>
constexpr Interface kInterface = {};

/// An enumeration that travels as one of these words; its values count up from 0.
struct NoWords {};
template <typename Enumeration>
constexpr NoWords kWords = {};

template <typename T>
concept IsMessage = !kInterface<std::remove_cvref_t<T>>.name.empty();

template <typename T>
concept IsWord = !std::is_same_v<std::remove_cvref_t<decltype(kWords<T>)>, NoWords>;

/// T is Message or const Message: archives that read need the former, those that write the latter.
template <typename T, typename Message>
concept Is = std::is_same_v<std::remove_const_t<T>, Message>;

template <IsWord T>
std::string_view word_of(T value) {
  const auto index = static_cast<std::size_t>(value);
  return index < kWords<T>.size() ? kWords<T>[index] : "unknown";
}

}  // namespace hg::viewer_server
