/// The layout of every message in its datagram: layout(archive, message) passes the fields to an
/// archive in the order of the wire. Encoding, decoding and the tables of
/// docs/reference/device_protocol.md are such archives.
///
/// Messages of the protocol itself are sent as their fields() stand. Of the frames only the members
/// listed here are sent, in this order: a new member of a frame is recorded at once, and sent from
/// the protocol version on that lists it. An archive is called with name, value, note and unit.
/// Truth values and enumerations take 4 bytes; vectors of variable length have their count, 4 zero
/// bytes, and room for their largest length.
#pragma once

#include <cstddef>
#include <string>
#include <type_traits>

#include "hg/core/fields.h"
#include "hg/device/udp/protocol.h"

namespace hg::udp {

/// Name, note and unit of one field of a frame. Fields of inner structs have a path:
/// "safety.override_key".
struct FieldText {
  std::string name, note;
  Unit unit;
};

/// The archive that finds the text of the member at an address. Use text_of() below.
class FieldFinder {
 public:
  explicit FieldFinder(const void* wanted) : wanted_(wanted) {}

  template <typename T>
  void operator()(const char* name, const T& value, const char* note = "",
                  const Unit& unit = unit::kNone) {
    if constexpr (HasFields<T>) {
      const std::string outer = path_;
      path_ += std::string(name) + ".";
      fields(*this, value);
      path_ = outer;
    } else if (static_cast<const void*>(&value) == wanted_) {
      found = {path_ + name, note, unit};
    }
  }

  FieldText found;

 private:
  const void* wanted_;
  std::string path_;
};

/// Name, note and unit of a member of `frame`, from its fields(). Empty for anything else.
template <HasFields Frame, typename Member>
FieldText text_of(const Frame& frame, const Member& member) {
  FieldFinder finder(&member);
  fields(finder, frame);
  return finder.found;
}

/// Passes some members of a frame to an archive. Archives with kIgnoresText get empty texts, which
/// costs nothing.
template <typename Archive, typename Frame, typename Member>
void pass(Archive& a, Frame& frame, Member& member) {
  if constexpr (HasFields<Member>) {
    const auto pass_inner = [&](const char*, auto& inner, const char* = "",
                                const Unit& = unit::kNone) { pass(a, frame, inner); };
    fields(pass_inner, member);
  } else if constexpr (requires { Archive::kIgnoresText; }) {
    a("", member, "");
  } else {
    const FieldText text = text_of(frame, member);
    a(text.name.c_str(), member, text.note.c_str(), text.unit);
  }
}

template <typename Archive, typename Message>
void layout(Archive& a, Message& message) {
  fields(a, message);
}

template <typename Archive, Is<SensorFrame> T>
void layout(Archive& a, T& sensors) {
  const auto send = [&](auto&... members) { (pass(a, sensors, members), ...); };
  send(sensors.sequence, sensors.time_s, sensors.answered_sequence, sensors.dead_man,
       sensors.safety, sensors.driver_fault, sensors.bus_errors);
  send(sensors.q_m, sensors.dq_m, sensors.theta_m, sensors.tau_m, sensors.q_p);
  send(sensors.w_S, sensors.a_S, sensors.omega_S, sensors.temperature_m);
}

template <typename Archive, Is<CommandFrame> T>
void layout(Archive& a, T& command) {
  const auto send = [&](auto&... members) { (pass(a, command, members), ...); };
  send(command.sequence, command.enable);
  send(command.hand_target.active, command.hand_target.p_B, command.hand_target.press);
  send(command.panel);
  a.zeros("zero");
  send(command.q_m, command.dq_m, command.ddq_m, command.tau_m, command.dq_p);
}

}  // namespace hg::udp
