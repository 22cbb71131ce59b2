/// Concept of a recorded message: a name and a function fields(archive, message) that passes its
/// fields to an archive in the order of the schema.
///
/// For each field the function calls archive(name, value, note), or archive.sequence(name, items,
/// count, note) where only the first `count` items of an array are in use. Values are numbers,
/// enumerations, strings, Eigen vectors and matrices (matrices row by row; those of variable length
/// are sequences), other messages and std::vector of these. Names are in lower case because ROS
/// demands it; notes become comments of the schema.
#pragma once

#include <concepts>
#include <string_view>
#include <type_traits>

namespace hg::recording {

/// Name of a message type in ROS notation inside a definition, for example "std_msgs/Header".
template <typename Message>
constexpr std::string_view kMessageName = "";

template <typename T>
concept IsMessage = !kMessageName<std::remove_cvref_t<T>>.empty();

/// Matches Message and const Message: reading archives need the former, writing archives the
/// latter.
template <typename T, typename Message>
concept Is = std::same_as<std::remove_const_t<T>, Message>;

template <typename T>
concept IsScalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

}  // namespace hg::recording
