/// The fields of every message, each written once: encoding, decoding and the tables of
/// docs/device_protocol.md come from passing an archive to fields().
///
/// An archive is called with name, value and note. Truth values and enumerations take 4 bytes;
/// vectors of variable length have their count, 4 zero bytes, and room for their largest length.
#pragma once

#include <concepts>
#include <type_traits>

#include "hg/remote/protocol.h"

namespace hg::remote {

/// T is Message or const Message: archives that read need the former, those that write the latter.
template <typename T, typename Message>
concept Is = std::same_as<std::remove_const_t<T>, Message>;

template <typename Archive, Is<Header> T>
void fields(Archive& a, T& header) {
  a("magic", header.magic, "48 47 44 50, \"HGDP\"");
  a("version", header.version, "of this protocol: 2");
  a("type", header.type, "of the message");
  a("length", header.length, "of the datagram, header and checksum included");
  a("session", header.session, "as the welcome says; 0 in hello and in a refusal");
  a("number", header.number,
    "1, 2, 3 .. of the datagrams that the sender has sent in this session");
  a("time_ns", header.time_ns, "when it was sent, on the sender's clock");
}

template <typename Archive, Is<Description> T>
void fields(Archive& a, T& description) {
  a("device", description.device, "name of the device as in its device.yaml, UTF-8");
  a("n_p", description.n_p, "gantry axes, 0..2");
  a("n_m", description.n_m, "joints of the manipulator, 1..7");
  a("rate_Hz", description.rate_Hz, "frames per second");
  a("interface", description.interface, "1 the drives follow q_m, 2 they are told torques");
  a("is_lock_step", description.is_lock_step, "0 real time, 1 lock-step");
}

template <typename Archive, Is<Hello> T>
void fields(Archive& a, T& hello) {
  a("nonce", hello.nonce, "any number, comes back in the welcome");
  fields(a, hello.expected);
  a("client", hello.client, "for the log, UTF-8");
}

template <typename Archive, Is<Welcome> T>
void fields(Archive& a, T& welcome) {
  a("nonce", welcome.nonce, "of the hello that it answers");
  a("refusal", welcome.refusal, "0 none, 1 busy, 2 version, 3 descriptions do not fit, 4 key");
  a("is_simulated", welcome.is_simulated, "1: a simulation, where no machine moves");
  fields(a, welcome.actual);
  a("command_timeout_s", welcome.command_timeout_s, "without a command for so long: drives off");
  a("server", welcome.server, "for the log, UTF-8");
  a("reason", welcome.reason, "of a refusal, for people, UTF-8");
}

template <typename Archive, Is<Ready> T>
void fields(Archive&, T&) {}

template <typename Archive, Is<SensorFrame> T>
void fields(Archive& a, T& sensors) {
  a("sequence", sensors.sequence, "counts up by one per period");
  a("time_s", sensors.time_s, "the device's clock, s");
  a("answered_sequence", sensors.answered_sequence,
    "of the newest command at work; 0 = none yet. A torque loop needs it, see "
    "[control.md](control.md)");
  a("dead_man", sensors.dead_man, "1: the dead-man switch is closed");
  a("emergency_stop", sensors.safety.emergency_stop, "1: the safety inputs ask for a stop");
  a("operator_enable", sensors.safety.operator_enable,
    "1: the operator holds the enabling switch, or there is none");
  a("override_key", sensors.safety.override_key, "1: it may move slowly with nobody at the handle");
  a("is_field_clear", sensors.safety.is_field_clear,
    "1: nobody stands in the scanner's field, or there is no scanner");
  a("has_disagreement", sensors.safety.has_disagreement,
    "1: channels of a safety input differed for too long");
  a("driver_fault", sensors.driver_fault, "0, or a number of hg/signals/fault.h");
  a("bus_errors", sensors.bus_errors, "fieldbus answers missing in this sample");
  a("q_m", sensors.q_m, "link-side encoders, rad; unlimited joints in [-pi, pi)");
  a("dq_m", sensors.dq_m, "link-side velocities, rad/s");
  a("theta_m", sensors.theta_m,
    "motor-side encoders at the output of the gear, rad; may be none with interface 1");
  a("tau_m", sensors.tau_m, "joint torque sensors, Nm; may be none with interface 1");
  a("q_p", sensors.q_p, "gantry encoders, m");
  a("w_S", sensors.w_S, "wrench on the handle at the sensor S, in S: force N, torque Nm");
  a("a_S", sensors.a_S, "accelerometer in S: acceleration minus gravity, m/s^2");
  a("omega_S", sensors.omega_S, "gyroscope in S, rad/s");
  a("temperature_m", sensors.temperature_m, "of the motors, degrees Celsius; may be none");
}

template <typename Archive, Is<CommandFrame> T>
void fields(Archive& a, T& command) {
  a("sequence", command.sequence, "of the sensors that it answers");
  a("enable", command.enable, "1: drives powered; 0: drives off, brakes closed");
  a("hand_active", command.hand_target.active, "1: a simulated person follows hand_p_B");
  a("hand_p_B", command.hand_target.p_B, "target of the handle in the base frame, m");
  a("hand_press", command.hand_target.press, "how far the hand presses its lever, 0..1");
  a("panel_emergency_stop", command.panel.emergency_stop, "1: for a simulated safety controller");
  a("panel_operator_enable", command.panel.operator_enable, "the same");
  a("panel_override_key", command.panel.override_key, "the same");
  a("panel_person_in_field", command.panel.person_in_field, "the same");
  a("panel_reset", command.panel.reset, "the same");
  a.zeros("zero");
  a("q_m", command.q_m, "reference positions, rad");
  a("dq_m", command.dq_m, "reference velocities, rad/s");
  a("ddq_m", command.ddq_m, "reference accelerations, rad/s^2");
  a("tau_m", command.tau_m, "motor torques, Nm; none with interface 1");
  a("dq_p", command.dq_p, "gantry velocities, m/s");
}

template <typename Archive, Is<Goodbye> T>
void fields(Archive& a, T& goodbye) {
  a("farewell", goodbye.farewell, "1 as planned, 2 the client has a fault, 3 silence");
  a.zeros("zero");
  a("reason", goodbye.reason, "for people, UTF-8");
}

}  // namespace hg::remote
