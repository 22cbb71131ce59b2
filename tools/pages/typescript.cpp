#include "tools/pages/typescript.h"

#include <array>
#include <concepts>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hg/viewer_server/command_message.h"
#include "hg/viewer_server/frame_message.h"
#include "hg/viewer_server/scene_message.h"

namespace hg::pages {
namespace {

using namespace viewer_server;

constexpr std::string_view kHead =
    "// Generated from the lists of fields in hg/viewer_server/ and hg/signals/; do not edit. "
    "Units\n"
    "// stand in the names or in the comments; B is the base frame (z up), H the handle. A number\n"
    "// that is not finite arrives as null.\n"
    "\n"
    "export type Vec3 = [number, number, number];\n"
    "export type Quaternion = [number, number, number, number]; // x y z w\n";

template <typename T>
struct Type;

template <typename T>
requires IsWord<T>
struct Type<T> {
  static std::string name() {
    std::string text;
    for (const std::string_view word : words<T>()) {
      ((text += text.empty() ? "\"" : " | \"") += word) += '"';
    }
    return text;
  }
};

template <IsMessage T>
struct Type<T> {
  static std::string name() { return std::string(kInterface<T>.name); }
};

template <typename T>
requires std::is_arithmetic_v<T>
struct Type<T> {
  static std::string name() { return std::same_as<T, bool> ? "boolean" : "number"; }
};

template <>
struct Type<std::string> {
  static std::string name() { return "string"; }
};

template <>
struct Type<Eigen::Vector3d> {
  static std::string name() { return "Vec3"; }
};

template <>
struct Type<Vec3> {
  static std::string name() { return "Vec3"; }
};

template <>
struct Type<Quaternion> {
  static std::string name() { return "Quaternion"; }
};

template <typename T>
struct Type<std::optional<T>> {
  static std::string name() { return Type<T>::name() + " | null"; }
};

template <typename T>
struct Type<std::vector<T>> {
  static std::string name() {
    const std::string item = Type<T>::name();
    return item.find('|') == std::string::npos ? item + "[]" : "(" + item + ")[]";
  }
};

// The archive that writes the fields of one interface.
class InterfaceWriter {
 public:
  void type(std::string_view word) { line("type", '"' + std::string(word) + '"', {}); }

  template <typename T>
  void operator()(std::string_view name, const T&, std::string_view note = {}) {
    line(name, Type<T>::name(), note);
  }

  std::string text;

 private:
  void line(std::string_view name, const std::string& type, std::string_view note) {
    ((text += "  ") += name) += ": " + type + ";";
    if (!note.empty()) (text += " // ") += note;
    text += '\n';
  }
};

// A message of a view that is not there.
template <IsMessage Message>
Message blank() {
  static const View view{};
  static const LimitCatalogue limits{};
  if constexpr (std::same_as<Message, FrameMessage>) {
    return {view, limits};
  } else if constexpr (std::same_as<Message, SafetyMessage>) {
    return {view};
  } else {
    return Message{};
  }
}

template <IsMessage Message>
void add(std::string& text) {
  InterfaceWriter writer;
  const Message message = blank<Message>();
  fields(writer, message);
  ((text += "\n// ") += kInterface<Message>.note) += '\n';
  ((text += "export interface ") += kInterface<Message>.name) += " {\n" + writer.text + "}\n";
}

template <IsMessage... Messages>
void add_all(std::string& text) {
  (add<Messages>(text), ...);
}

}  // namespace

std::string typescript_text() {
  std::string text(kHead);
  add_all<Scene, SceneChain, SceneJoint, SceneLimitMessage, Eigen::AlignedBox3d, SceneSurface,
          Choices, Choice, Setting>(text);
  add_all<FrameMessage, FeltLimitMessage, ActiveLimitMessage, ContactReport, HandBudget, Vector6,
          Singularity, RunState, SafetyMessage, Ghost>(text);
  add_all<HandMessage, HoldMessage, CommandMessage, WelcomeMessage, AnswerMessage, ValuesMessage,
          EventMessage>(text);
  return text;
}

}  // namespace hg::pages
