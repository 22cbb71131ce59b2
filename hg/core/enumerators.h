/// Enumerators of an enum, from the compiler: no second list by hand.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace hg {

/// One enumerator, its name as in the source: "kStillMoving".
template <typename E>
struct Enumerator {
  E value{};
  std::string_view name;
};

namespace detail {

// GCC and Clang write an enumerator as "hg::Refusal::kNone" and any other value as
// "(hg::Refusal)99".
template <auto kValue>
constexpr std::string_view name_of() {
  std::string_view text = __PRETTY_FUNCTION__;
  text = text.substr(text.find("kValue = ") + 9);
  text = text.substr(0, text.find_first_of(";]"));
  return text.starts_with('(') ? std::string_view{} : text.substr(text.rfind(':') + 1);
}

template <typename E, std::size_t... kIndex>
constexpr auto candidates(std::index_sequence<kIndex...>) {
  return std::array{Enumerator<E>{static_cast<E>(kIndex), name_of<static_cast<E>(kIndex)>()}...};
}

// Passes the name's characters on in lower case, without its "k" and with `separator` between
// words.
constexpr void separate(std::string_view enumerator, char separator, auto&& append) {
  for (std::size_t i = 1; i < enumerator.size(); ++i) {
    const char c = enumerator[i];
    const bool is_upper = c >= 'A' && c <= 'Z';
    if (is_upper && i > 1) append(separator);
    append(is_upper ? static_cast<char>(c - 'A' + 'a') : c);
  }
}

struct Key {
  std::array<char, 32> text{};
  std::size_t size = 0;
};

template <auto kValue>
inline constexpr Key kKey = [] {
  Key key;
  separate(name_of<kValue>(), '_', [&](char c) { key.text[key.size++] = c; });
  return key;
}();

}  // namespace detail

/// Name of an enumerator in files and options: kEitherWay is "either_way".
template <auto kValue>
constexpr std::string_view key_name() {
  return {detail::kKey<kValue>.text.data(), detail::kKey<kValue>.size};
}

/// All enumerators of E with values from 0 to below `kEnd`, in the order of their values.
template <typename E, std::size_t kEnd = 64>
constexpr auto enumerators() {
  constexpr auto kAll = detail::candidates<E>(std::make_index_sequence<kEnd>{});
  constexpr std::size_t kCount = [&] {
    std::size_t named = 0;
    for (const Enumerator<E>& one : kAll) named += one.name.empty() ? 0 : 1;
    return named;
  }();
  std::array<Enumerator<E>, kCount> found{};
  std::size_t next = 0;
  for (const Enumerator<E>& one : kAll) {
    if (!one.name.empty()) found[next++] = one;
  }
  return found;
}

/// Words of an enumerator's name: "kStillMoving" becomes "still moving".
inline std::string words_of(std::string_view enumerator) {
  std::string words;
  detail::separate(enumerator, ' ', [&](char c) { words += c; });
  return words;
}

/// Words of a value: of E::kStillMoving, "still moving"; empty for a value without a name.
template <typename E>
requires std::is_enum_v<E> std::string words_of(E value) {
  for (const Enumerator<E>& one : enumerators<E>()) {
    if (one.value == value) return words_of(one.name);
  }
  return {};
}

/// Constant name of an enumerator in other languages: "kStillMoving" becomes "STILL_MOVING".
inline std::string constant_name(std::string_view enumerator) {
  std::string name;
  detail::separate(enumerator, '_', [&](char c) {
    name += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return name;
}

/// Text of all enumerators of E with their numbers: "0 none, 1 not tared".
template <typename E>
std::string numbers_of() {
  std::string text;
  for (const Enumerator<E>& one : enumerators<E>()) {
    if (!text.empty()) text += ", ";
    text += std::to_string(static_cast<int>(one.value)) + " " + words_of(one.name);
  }
  return text;
}

}  // namespace hg
