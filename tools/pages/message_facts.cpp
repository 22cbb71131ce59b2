#include "tools/pages/message_facts.h"

#include <array>
#include <concepts>
#include <nlohmann/json.hpp>
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

using Json = nlohmann::ordered_json;

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

// The archive that lists the fields of one interface.
class Fields {
 public:
  void type(std::string_view word) { rows.push_back({"type", '"' + std::string(word) + '"', ""}); }

  template <typename T>
  void operator()(std::string_view name, const T&, std::string_view note = {},
                  const Unit& unit = unit::kNone) {
    rows.push_back({name, Type<T>::name(), with_unit(std::string(note), unit)});
  }

  Json rows = Json::array();
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
Json facts_of() {
  Fields list;
  const Message message = blank<Message>();
  fields(list, message);
  return {{"name", kInterface<Message>.name},
          {"note", kInterface<Message>.note},
          {"fields", list.rows}};
}

template <IsMessage... Messages>
Json all() {
  return {facts_of<Messages>()...};
}

}  // namespace

Json message_facts() {
  return all<Scene, SceneChain, SceneJoint, SceneFollower, SceneLimitMessage, Eigen::AlignedBox3d,
             SceneSurface, SceneShape, SceneCheckpoint, SceneTeleoperation, SceneAxis, SceneWall,
             Choices, Choice, Setting, FrameMessage, FeltLimitMessage, ActiveLimitMessage,
             ContactReport, HandBudget, Vector6, Singularity, RunState, SafetyMessage,
             TwinBaseMessage, Ghost, TeleoperationView, HandMessage, HoldMessage, CommandMessage,
             WelcomeMessage, AnswerMessage, ValuesMessage, EventMessage>();
}

}  // namespace hg::pages
