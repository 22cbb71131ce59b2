/// Messages of ROS 2 that a bridge reads or makes itself; see hg/messages for the others.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/fields.h"

namespace hg::ros2 {

/// rcl_interfaces/msg/ParameterValue; `type` says which value counts
struct ParameterValue {
  enum Type : std::uint8_t { kNotSet, kBool, kInteger, kDouble, kString, kDoubles = 8 };
  std::uint8_t type = kNotSet;
  bool bool_value = false;
  std::int64_t integer_value = 0;
  double double_value = 0.0;
  std::string string_value;
  std::vector<std::uint8_t> byte_array_value, bool_array_value;
  std::vector<std::int64_t> integer_array_value;
  std::vector<double> double_array_value;
  std::vector<std::string> string_array_value;
};

struct Parameter {
  std::string name;
  ParameterValue value;
};

struct FloatingPointRange {
  double from_value = 0.0, to_value = 0.0, step = 0.0;
};

struct IntegerRange {
  std::int64_t from_value = 0, to_value = 0;
  std::uint64_t step = 0;
};

struct ParameterDescriptor {
  std::string name;
  std::uint8_t type = 0;
  std::string description, additional_constraints;
  bool read_only = false, dynamic_typing = false;
  std::vector<FloatingPointRange> floating_point_range;
  std::vector<IntegerRange> integer_range;
};

struct SetParametersResult {
  bool successful = false;
  std::string reason;
};

/// Requests that are a list of names: GetParameters, GetParameterTypes, DescribeParameters
struct Names {
  std::vector<std::string> names;
};

/// A list as the only field of a request or response
template <typename Item>
struct List {
  std::vector<Item> items;
};

struct ListParametersRequest {
  std::vector<std::string> prefixes;
  std::uint64_t depth = 0;
};

struct ListParametersResponse {
  std::vector<std::string> names, prefixes;
};

template <typename Archive, Is<ParameterValue> T>
void fields(Archive& a, T& value) {
  a("type", value.type);
  a("bool_value", value.bool_value);
  a("integer_value", value.integer_value);
  a("double_value", value.double_value);
  a("string_value", value.string_value);
  a("byte_array_value", value.byte_array_value);
  a("bool_array_value", value.bool_array_value);
  a("integer_array_value", value.integer_array_value);
  a("double_array_value", value.double_array_value);
  a("string_array_value", value.string_array_value);
}

template <typename Archive, Is<Parameter> T>
void fields(Archive& a, T& parameter) {
  a("name", parameter.name);
  a("value", parameter.value);
}

template <typename Archive, Is<FloatingPointRange> T>
void fields(Archive& a, T& range) {
  a("from_value", range.from_value);
  a("to_value", range.to_value);
  a("step", range.step);
}

template <typename Archive, Is<IntegerRange> T>
void fields(Archive& a, T& range) {
  a("from_value", range.from_value);
  a("to_value", range.to_value);
  a("step", range.step);
}

template <typename Archive, Is<ParameterDescriptor> T>
void fields(Archive& a, T& descriptor) {
  a("name", descriptor.name);
  a("type", descriptor.type);
  a("description", descriptor.description);
  a("additional_constraints", descriptor.additional_constraints);
  a("read_only", descriptor.read_only);
  a("dynamic_typing", descriptor.dynamic_typing);
  a("floating_point_range", descriptor.floating_point_range);
  a("integer_range", descriptor.integer_range);
}

template <typename Archive, Is<SetParametersResult> T>
void fields(Archive& a, T& result) {
  a("successful", result.successful);
  a("reason", result.reason);
}

template <typename Archive, Is<Names> T>
void fields(Archive& a, T& names) {
  a("names", names.names);
}

template <typename Archive, Is<ListParametersRequest> T>
void fields(Archive& a, T& request) {
  a("prefixes", request.prefixes);
  a("depth", request.depth);
}

template <typename Archive, Is<ListParametersResponse> T>
void fields(Archive& a, T& response) {
  a("names", response.names);
  a("prefixes", response.prefixes);
}

template <typename Archive, typename Item>
void fields(Archive& a, List<Item>& list) {
  a("items", list.items);
}
template <typename Archive, typename Item>
void fields(Archive& a, const List<Item>& list) {
  a("items", list.items);
}

}  // namespace hg::ros2
