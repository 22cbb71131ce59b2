/// The archive that reads a message from JSON; accepts exactly the fields of the message.
///
/// A field that may be null may be missing. Numbers must be finite.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "hg/viewer_server/message.h"

namespace hg::viewer_server {

class JsonReader {
 public:
  explicit JsonReader(const nlohmann::json& object) : object_(object) {}

  /// Reads a message. False unless `object` is exactly such a message; `message` may be changed
  /// even then.
  template <IsMessage Message>
  bool read(Message& message) {
    if (!object_.is_object()) return false;
    fields(*this, message);
    return is_right_ && known_ == object_.size();
  }

  void type(std::string_view word) {
    const nlohmann::json* field = find("type");
    is_right_ = is_right_ && field != nullptr && field->is_string() && *field == word;
  }

  template <typename T>
  void operator()(std::string_view name, T& field, std::string_view = {},
                  const Unit& = unit::kNone) {
    const nlohmann::json* json = find(name);
    is_right_ = is_right_ && json != nullptr && take(*json, field);
  }

  template <typename T>
  void operator()(std::string_view name, std::optional<T>& field, std::string_view = {},
                  const Unit& = unit::kNone) {
    const nlohmann::json* json = find(name);
    field.reset();
    if (json == nullptr || json->is_null()) return;
    is_right_ = take(*json, field.emplace()) && is_right_;
  }

 private:
  const nlohmann::json* find(std::string_view name) {
    const auto field = object_.find(name);
    if (field == object_.end()) return nullptr;
    ++known_;
    return &*field;
  }

  static bool take(const nlohmann::json& json, bool& value) {
    if (json.is_boolean()) value = json.get<bool>();
    return json.is_boolean();
  }

  static bool take(const nlohmann::json& json, double& value) {
    if (!json.is_number()) return false;
    value = json.get<double>();
    return std::isfinite(value);
  }

  static bool take(const nlohmann::json& json, std::string& value) {
    if (json.is_string()) value = json.get<std::string>();
    return json.is_string();
  }

  template <IsWord T>
  static bool take(const nlohmann::json& json, T& value) {
    for (std::size_t i = 0; i < words<T>().size(); ++i) {
      if (json != words<T>()[i]) continue;
      value = enumerators<T>()[i].value;
      return true;
    }
    return false;
  }

  template <std::size_t kCount>
  static bool take(const nlohmann::json& json, std::array<double, kCount>& values) {
    if (!json.is_array() || json.size() != kCount) return false;
    for (std::size_t i = 0; i < kCount; ++i) {
      if (!take(json[i], values[i])) return false;
    }
    return true;
  }

  const nlohmann::json& object_;
  std::size_t known_ = 0;  ///< fields of the object that were read
  bool is_right_ = true;
};

}  // namespace hg::viewer_server
