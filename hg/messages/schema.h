/// The text of a message's schema in the format ros2msg: its fields, then the definition of every
/// message inside it, each once, in the order of first use.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hg/core/types.h"
#include "hg/messages/message.h"

namespace hg::messages {

/// The archive that collects definitions. Use schema_text() below.
class SchemaWriter {
 public:
  template <HasFields Message>
  void define() {
    fields(*this, static_cast<const Message&>(Message{}));
  }

  template <typename T>
  void operator()(const char* name, const T&, const char* note = "",
                  const Unit& unit = unit::kNone) {
    line(type_name(static_cast<const T*>(nullptr)), name, with_unit(with_numbers<T>(note), unit));
  }

  template <typename T, std::size_t kCapacity>
  void sequence(const char* name, const std::array<T, kCapacity>&, int, const char* note) {
    line(type_name(static_cast<const T*>(nullptr)) + "[]", name, note);
  }

  std::string text;  ///< text of the current message
  struct Definition {
    std::string name, text;
  };
  std::vector<Definition> inner;  ///< definitions of the messages inside it

 private:
  template <IsScalar T>
  static std::string type_name(const T*) {
    if constexpr (std::is_enum_v<T>) {
      return type_name(static_cast<const std::underlying_type_t<T>*>(nullptr));
    } else if constexpr (std::same_as<T, bool>) {
      return "bool";
    } else {
      const char* kind = std::floating_point<T>    ? "float"
                         : std::signed_integral<T> ? "int"
                                                   : "uint";
      return kind + std::to_string(8 * sizeof(T));
    }
  }

  static std::string type_name(const std::string*) { return "string"; }

  template <typename T>
  std::string type_name(const std::vector<T>*) {
    return type_name(static_cast<const T*>(nullptr)) + "[]";
  }

  template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  static std::string type_name(
      const Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>*) {
    return kRows == Eigen::Dynamic ? "float64[]" : "float64[" + std::to_string(kRows * kCols) + "]";
  }

  template <HasFields T>
  std::string type_name(const T*) {
    const std::string name = message_name<T>();
    for (const Definition& known : inner) {
      if (known.name == name) return name;
    }
    const std::size_t index = inner.size();
    inner.push_back({name, ""});
    std::string outer;
    outer.swap(text);
    define<T>();
    inner[index].text.swap(text);
    text.swap(outer);
    return name;
  }

  void line(const std::string& type, const char* name, const std::string& note) {
    text += type + " " + name + (note.empty() ? "" : "  # " + note) + "\n";
  }
};

/// Schema of a message and of everything inside it.
template <HasFields Message>
std::string schema_text() {
  SchemaWriter writer;
  writer.define<Message>();
  std::string text = writer.text;
  for (const SchemaWriter::Definition& definition : writer.inner) {
    text.append(80, '=').append("\nMSG: ").append(definition.name).append("\n");
    text += definition.text;
  }
  return text;
}

/// Name of a message type in schema notation: package/msg/Type.
template <HasFields Message>
std::string schema_name() {
  std::string name = message_name<Message>();
  return name.insert(name.find('/'), "/msg");
}

}  // namespace hg::messages
