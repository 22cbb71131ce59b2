/// Recorded messages: structs with a list of fields (hg/core/fields.h), encoded in the order of
/// that list.
///
/// Values are numbers, enumerations, strings, Eigen vectors and matrices (matrices row by row;
/// those of variable length are sequences), other messages and std::vector of these.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include "hg/core/fields.h"

namespace hg::messages {

/// Name of a standard message in ROS notation inside a definition, for example "std_msgs/Header".
/// Empty for our own messages, which have the name of their struct.
template <typename Message>
constexpr std::string_view kStandardName = "";

/// Name of a message in ROS notation inside a definition, for example
/// "hapticgiant_msgs/SensorFrame".
template <HasFields Message>
std::string message_name() {
  if constexpr (kStandardName<Message>.empty()) {
    return "hapticgiant_msgs/" + std::string(struct_name<Message>());
  } else {
    return std::string(kStandardName<Message>);
  }
}

template <typename T>
concept IsScalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

}  // namespace hg::messages
