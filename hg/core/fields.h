/// Lists of fields. Beside a struct that is recorded, sent or bound stands one function
/// fields(archive, struct), which passes all its members to an archive. Recordings and their
/// schema, datagrams, JSON, TypeScript and Python are archives over these lists.
///
/// For each member the function calls archive(name, value, note, unit), or
/// archive.sequence(name, items, count, note) where only the first `count` items of an array are in
/// use. Names are in lower case, as ROS demands. The note is a fragment, readable on its own: it
/// becomes a comment of the schema, a docstring and a line of the documentation, and says what the
/// member is, so that a comment beside the member says only what the note does not. The unit is
/// required of floating-point numbers, unit::kNone included; no note has one.
#pragma once

#include <concepts>
#include <string_view>
#include <type_traits>

#include "hg/core/unit.h"

namespace hg {

/// Matches Struct and const Struct: reading archives need the former, writing archives the latter.
template <typename T, typename Struct>
concept Is = std::same_as<std::remove_const_t<T>, Struct>;

namespace detail {

struct AnyArchive {};

// GCC and Clang write the type as "T = hg::SensorFrame".
template <typename T>
constexpr std::string_view text_with_type() {
  return __PRETTY_FUNCTION__;
}

}  // namespace detail

/// Structs with a list of fields.
template <typename T>
concept HasFields = requires(detail::AnyArchive& archive, T& value) {
  fields(archive, value);
};

/// Name of a struct as in the source, without its namespace: "SensorFrame".
template <typename T>
constexpr std::string_view struct_name() {
  std::string_view text = detail::text_with_type<T>();
  text = text.substr(text.find("T = ") + 4);
  text = text.substr(0, text.find_first_of(";]"));
  return text.substr(text.rfind(':') + 1);
}

}  // namespace hg
