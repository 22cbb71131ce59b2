/// Messages between program and page: structs with an interface name and a list of fields
/// (hg/core/fields.h). JSON output and input and viewer/src/messages.ts are all generated from that
/// list.
///
/// A message of a socket begins with archive.type(word). Values: double, bool, std::string,
/// Eigen::Vector3d, Vec3, Quaternion, enumerations, other messages, and std::vector or
/// std::optional of these. A number that is not finite is null in JSON.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "hg/core/enumerators.h"
#include "hg/core/fields.h"
#include "hg/core/types.h"

namespace hg::viewer_server {

using Vec3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  ///< x y z w

inline Quaternion quaternion(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return {q.x(), q.y(), q.z(), q.w()};
}

/// A number that may be infinite, null in JSON.
inline std::optional<double> bounded(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Name of a message's interface in TypeScript, and one line about it.
struct Interface {
  std::string_view name;
  std::string_view note;
};
template <typename Message>
constexpr Interface kInterface = {};

template <typename T>
concept IsMessage = !kInterface<std::remove_cvref_t<T>>.name.empty();

/// An enumeration is sent as one of its words: its to_string() where it has one, else the name of
/// the enumerator, kEmergencyStop as "emergency_stop".
template <typename T>
concept IsWord = std::is_enum_v<T>;

/// Words of all enumerators, in the order of enumerators<E>().
template <IsWord E>
const auto& words() {
  static const auto kWords = [] {
    constexpr auto kAll = enumerators<E>();
    std::array<std::string, kAll.size()> texts;
    for (std::size_t i = 0; i < kAll.size(); ++i) {
      if constexpr (requires(E value) { to_string(value); }) {
        texts[i] = to_string(kAll[i].value);
      } else {
        texts[i] = words_of(kAll[i].name);
        std::ranges::replace(texts[i], ' ', '_');
      }
    }
    return texts;
  }();
  return kWords;
}

template <IsWord E>
std::string_view word_of(E value) {
  constexpr auto kAll = enumerators<E>();
  for (std::size_t i = 0; i < kAll.size(); ++i) {
    if (kAll[i].value == value) return words<E>()[i];
  }
  return "unknown";
}

/// Passes the fields with these names to an archive.
template <typename Archive, HasFields Struct>
void pass_some(Archive& a, Struct& from, std::initializer_list<std::string_view> names) {
  const auto pass = [&](const char* name, auto& field, const char* note = "",
                        const Unit& unit = unit::kNone) {
    if (std::ranges::find(names, std::string_view(name)) != names.end()) a(name, field, note, unit);
  };
  fields(pass, from);
}

/// A wrench, force first.
template <>
inline constexpr Interface kInterface<Vector6> = {"Wrench", "wrench on the hand, at H, in B"};

template <typename Archive, Is<Vector6> T>
void fields(Archive& a, T& wrench) {
  a("force_N", Eigen::Vector3d(wrench.template head<3>()));
  a("torque_Nm", Eigen::Vector3d(wrench.template tail<3>()));
}

}  // namespace hg::viewer_server
