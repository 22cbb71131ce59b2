/// Small messages in both directions: the hand, commands and their answers, values, events. See
/// message.h for the rules.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/viewer_server/commands.h"
#include "hg/viewer_server/message.h"

namespace hg::viewer_server {

struct HandMessage {
  bool active = false;
  Vec3 p_B{};
  std::optional<Quaternion> quaternion_B_H;
  double press = 0.0;
};

struct HoldMessage {
  double sequence = 0.0;
};

struct WelcomeMessage {
  std::uint64_t page = 0;
};

struct CommandMessage {
  double id = 0.0;
  CommandName command = CommandName::kPause;
  std::string name;
  double value = 0.0;
};

struct AnswerMessage {
  double id = 0.0;
  bool is_accepted = false;
  std::string reason;
};

struct ValuesMessage {
  std::vector<std::optional<double>> values;
};

struct EventMessage {
  std::uint64_t run = 0;
  double time_s = 0.0;
  std::string name, text;
};

template <>
inline constexpr Interface kInterface<HandMessage> = {
    "Hand", "page -> program; inside a frame: the target in effect"};
template <>
inline constexpr Interface kInterface<HoldMessage> = {
    "Hold", "page -> program, every 30 ms: the page is alive and keeps its hold"};
template <>
inline constexpr Interface kInterface<WelcomeMessage> = {
    "Welcome", "program -> page: the first message of a connection"};
template <>
inline constexpr Interface kInterface<CommandMessage> = {"Command", "page -> program"};
template <>
inline constexpr Interface kInterface<AnswerMessage> = {
    "Answer", "program -> page: one per Command, and per refused message"};
template <>
inline constexpr Interface kInterface<ValuesMessage> = {
    "Values", "program -> page: at the connection and after each change"};
template <>
inline constexpr Interface kInterface<EventMessage> = {"Event", "program -> page"};

template <typename Archive, Is<HandMessage> T>
void fields(Archive& a, T& hand) {
  a.type("hand");
  a("active", hand.active);
  a("p_B_m", hand.p_B);
  a("quaternion_B_H", hand.quaternion_B_H,
    "target orientation of the handle; null = the handle may rotate freely");
  a("press", hand.press, "how far the hand presses its lever, 0..1", unit::kNone);
}

template <typename Archive, Is<HoldMessage> T>
void fields(Archive& a, T& hold) {
  a.type("hold");
  a("sequence", hold.sequence, "rising number; repeated and older ones are ignored", unit::kNone);
}

template <typename Archive, Is<WelcomeMessage> T>
void fields(Archive& a, T& welcome) {
  a.type("welcome");
  a("page", welcome.page, "number of this connection");
}

template <typename Archive, Is<CommandMessage> T>
void fields(Archive& a, T& command) {
  a.type("command");
  a("id", command.id, "any whole number of 0..2^53, comes back in the answer", unit::kNone);
  a("command", command.command);
  a("name", command.name, "name of the chosen option or setting; else empty");
  a("value", command.value,
    "step: cycles, speed: 0.1..1 (recordings ..8), seek: run time, set: value, release_stop: page, "
    "clutch: 1 open, 0 closed",
    unit::kNone);
}

template <typename Archive, Is<AnswerMessage> T>
void fields(Archive& a, T& answer) {
  a.type("answer");
  a("id", answer.id, "id of the command; -1 = the message could not be read", unit::kNone);
  a("is_accepted", answer.is_accepted, "mode: followed by the cycle; set, panel: passed on");
  a("reason", answer.reason, "reason of the refusal; empty = accepted");
}

template <typename Archive, Is<ValuesMessage> T>
void fields(Archive& a, T& values) {
  a.type("values");
  a("values", values.values, "values in the order of Scene.settings; null = unlimited",
    unit::kNone);
}

template <typename Archive, Is<EventMessage> T>
void fields(Archive& a, T& event) {
  a.type("event");
  a("run", event.run, "number of the run, as Scene.run");
  a("time_s", event.time_s);
  a("name", event.name);
  a("text", event.text);
}

}  // namespace hg::viewer_server
