/// The number of members of a struct, for lists that must cover all of them.
#pragma once

namespace hg {
namespace detail {

struct Anything {
  template <typename T>
  operator T() const;  // NOLINT(google-explicit-constructor): any member is made of it
};

}  // namespace detail

/// Members of an aggregate: how many values of any type it can be made from. Arrays of C count as
/// many.
template <typename T, typename... Values>
consteval int member_count() {
  if constexpr (requires { T{Values{}..., detail::Anything{}}; }) {
    return member_count<T, Values..., detail::Anything>();
  } else {
    return sizeof...(Values);
  }
}

}  // namespace hg
