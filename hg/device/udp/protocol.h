/// The messages between a controller and a remote device, one per datagram. Byte layout:
/// docs/reference/device_protocol.md. The order of frames on the wire: layout.h.
///
/// Little endian, fixed layout. No allocation, noexcept.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hg/core/fields.h"
#include "hg/device/udp/text.h"
#include "hg/signals/frames.h"

namespace hg::udp {

inline constexpr std::uint32_t kMagic = 0x50444748;  ///< "HGDP"
inline constexpr std::uint16_t kVersion = 2;
/// Largest datagram, bytes: not fragmented by any network.
inline constexpr std::size_t kLargestDatagram = 1400;

enum class MessageType : std::uint16_t {
  kHello = 1,      ///< client: its identity and expectations
  kWelcome = 2,    ///< device: its identity, or a refusal
  kReady = 3,      ///< client: start with the first frame
  kSensors = 4,    ///< device: sensor frame
  kCommand = 5,    ///< client: command frame
  kGoodbye = 6,    ///< either side: the session is over
  kRoundTrip = 7,  ///< device in real time: how late its commands come; may be ignored
  kTerms = 8,      ///< leader of a remote machine, as kReady: the method of both halves
  kLeader = 9,     ///< leader: a period of its side
  kRemote = 10,    ///< remote machine: a period of its side
};

/// Command interface of the drives: positions (they follow CommandFrame::q_m), or torques (tau_m).
/// kRemote: not a device, but the remote machine of a teleoperation (teleoperation_messages.h).
enum class Interface : std::uint32_t { kPosition = 1, kTorque = 2, kRemote = 3 };

/// Properties of a device on which both sides must agree.
struct Description {
  Text<64> device;
  std::uint32_t n_p = 0;
  std::uint32_t n_m = 0;
  double rate_Hz = 0.0;
  Interface interface = Interface::kPosition;
  bool is_lock_step = false;
};

template <typename Archive, Is<Description> T>
void fields(Archive& a, T& description) {
  a("device", description.device, "name of the device as in its device.yaml, UTF-8");
  a("n_p", description.n_p, "gantry axes, 0..2");
  a("n_m", description.n_m, "joints of the manipulator, or coordinates of the remote machine");
  a("rate_Hz", description.rate_Hz, "rate of frames", unit::kHz);
  a("interface", description.interface,
    "1: the drives follow q_m, 2: the drives give tau_m, 3: a remote machine");
  a("is_lock_step", description.is_lock_step,
    "0: real time, 1: lock-step, each side waits for the other");
}

enum class ConnectionRefusal : std::uint32_t {
  kNone = 0,
  kBusy = 1,      ///< another client has the device
  kProtocol = 2,  ///< other protocol version
  kMismatch = 3,  ///< descriptions differ
  kKey = 4,       ///< the tag of the shared key is wrong, missing or not expected
};

enum class Farewell : std::uint32_t {
  kDone = 1,    ///< session ended as planned
  kFault = 2,   ///< the client stopped because of a fault
  kSilent = 3,  ///< the other side fell silent
};

/// Header of every message.
struct Header {
  std::uint32_t magic = kMagic;
  std::uint16_t version = kVersion;
  std::uint16_t type = 0;
  std::uint32_t length = 0;
  std::uint32_t session = 0;
  std::uint64_t number = 0;
  std::uint64_t time_ns = 0;
};

template <typename Archive, Is<Header> T>
void fields(Archive& a, T& header) {
  a("magic", header.magic, "48 47 44 50, \"HGDP\"");
  a("version", header.version, "version of this protocol: 2");
  a("type", header.type, "type of the message");
  a("length", header.length, "length of the datagram with header and checksum", unit::kBytes);
  a("session", header.session, "number from the welcome; 0 in a hello and in a refusal");
  a("number", header.number, "1, 2, 3 .. for the sender's datagrams of this session");
  a("time_ns", header.time_ns, "time of sending on the sender's clock", unit::kNs);
}

struct Hello {
  std::uint64_t nonce = 0;
  Description expected;
  Text<64> client;
};

template <typename Archive, Is<Hello> T>
void fields(Archive& a, T& hello) {
  a("nonce", hello.nonce, "any number, comes back in the welcome");
  fields(a, hello.expected);
  a("client", hello.client, "text for the log, UTF-8");
}

struct Welcome {
  std::uint64_t nonce = 0;
  ConnectionRefusal refusal = ConnectionRefusal::kNone;
  bool is_simulated = false;
  Description actual;
  double command_timeout_s = 0.0;
  Text<64> server;
  Text<192> reason;
};

template <typename Archive, Is<Welcome> T>
void fields(Archive& a, T& welcome) {
  a("nonce", welcome.nonce, "nonce of the answered hello");
  a("refusal", welcome.refusal, "0 none, 1 busy, 2 version, 3 descriptions do not fit, 4 key");
  a("is_simulated", welcome.is_simulated,
    "1: a simulation, where no machine moves, whatever is commanded");
  fields(a, welcome.actual);
  a("command_timeout_s", welcome.command_timeout_s,
    "time without a command after which the drives are switched off", unit::kS);
  a("server", welcome.server, "text for the log, UTF-8");
  a("reason", welcome.reason, "reason of a refusal for people, UTF-8");
}

struct Ready {};

template <typename Archive, Is<Ready> T>
void fields(Archive&, T&) {}

struct Goodbye {
  Farewell farewell = Farewell::kDone;
  Text<64> reason;
};

template <typename Archive, Is<Goodbye> T>
void fields(Archive& a, T& goodbye) {
  a("farewell", goodbye.farewell, "1 as planned, 2 the client has a fault, 3 silence");
  a.zeros("zero");
  a("reason", goodbye.reason, "reason for people, UTF-8");
}

/// Message type number of each C++ type.
template <typename Message>
inline constexpr MessageType kTypeOf = MessageType{};
template <>
inline constexpr MessageType kTypeOf<Hello> = MessageType::kHello;
template <>
inline constexpr MessageType kTypeOf<Welcome> = MessageType::kWelcome;
template <>
inline constexpr MessageType kTypeOf<Ready> = MessageType::kReady;
template <>
inline constexpr MessageType kTypeOf<SensorFrame> = MessageType::kSensors;
template <>
inline constexpr MessageType kTypeOf<CommandFrame> = MessageType::kCommand;
template <>
inline constexpr MessageType kTypeOf<Goodbye> = MessageType::kGoodbye;

}  // namespace hg::udp
