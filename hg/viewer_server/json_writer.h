/// The archive that writes a message as JSON. Use to_json().
///
/// Numbers are rounded to 1e-5 of their unit; numbers that are not finite become null; texts are
/// made visible() (hg/core/visible.h).
#pragma once

#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hg/viewer_server/message.h"

namespace hg::viewer_server {

class JsonWriter {
 public:
  template <IsMessage Message>
  void message(const Message& message) {
    text += '{';
    fields(*this, message);
    close('}');
  }

  void type(std::string_view word) { (*this)("type", word); }

  template <typename T>
  void operator()(std::string_view name, const T& field, std::string_view = {},
                  const Unit& = unit::kNone) {
    (text += '"').append(name) += "\":";
    value(field);
    text += ',';
  }

  std::string text;

 private:
  template <typename T>
  void value(const T& value) {
    if constexpr (std::same_as<T, bool>) {
      text += value ? "true" : "false";
    } else if constexpr (std::is_arithmetic_v<T>) {
      number(static_cast<double>(value));
    } else if constexpr (IsWord<T>) {
      quoted(word_of(value));
    } else if constexpr (IsMessage<T>) {
      message(value);
    } else {
      quoted(value);
    }
  }

  template <typename T>
  void value(const std::optional<T>& item) {
    if (item) return value(*item);
    text += "null";
  }

  template <typename T>
  void value(const std::vector<T>& items) {
    list(items);
  }

  template <typename T, std::size_t kCount>
  void value(const std::array<T, kCount>& items) {
    list(items);
  }

  void value(const Eigen::Vector3d& v) { list(Vec3{v.x(), v.y(), v.z()}); }

  template <typename List>
  void list(const List& items) {
    text += '[';
    for (const auto& item : items) {
      value(item);
      text += ',';
    }
    close(']');
  }

  // replaces the comma after the last item, if there is one
  void close(char bracket) {
    if (text.back() == ',') {
      text.back() = bracket;
    } else {
      text += bracket;
    }
  }

  void number(double value);
  void quoted(std::string_view words);
};

template <IsMessage Message>
std::string to_json(const Message& message) {
  JsonWriter writer;
  writer.message(message);
  return std::move(writer.text);
}

}  // namespace hg::viewer_server
