/// The messages between a controller and a remote device, one per datagram. Byte layout:
/// docs/reference/device_protocol.md; the fields are defined only in message_fields.h.
///
/// Little endian, fixed layout. No allocation, noexcept.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "hg/signals/frames.h"

namespace hg::udp {

inline constexpr std::uint32_t kMagic = 0x50444748;  ///< "HGDP"
inline constexpr std::uint16_t kVersion = 2;
/// Largest datagram, bytes: not fragmented by any network.
inline constexpr std::size_t kLargestDatagram = 1400;

enum class MessageType : std::uint16_t {
  kHello = 1,    ///< client: its identity and expectations
  kWelcome = 2,  ///< device: its identity, or a refusal
  kReady = 3,    ///< client: start with the first frame
  kSensors = 4,  ///< device: sensor frame
  kCommand = 5,  ///< client: command frame
  kGoodbye = 6,  ///< either side: the session is over
};

/// Foreign text made safe for a terminal, in one line: a '?' for each byte that is not shown
/// (hg/core/visible.h).
std::string printable(std::string_view text);

/// Text of fixed capacity; longer text is cut.
template <std::size_t kSize>
struct Text {
  std::array<char, kSize> bytes{};

  Text() = default;
  template <std::convertible_to<std::string_view> T>
  Text(const T& value) noexcept {  // NOLINT(google-explicit-constructor)
    const std::string_view text = value;
    std::memcpy(bytes.data(), text.data(), std::min(text.size(), kSize));
  }
  /// Text as received; use printable() for display.
  std::string_view view() const noexcept {
    return {bytes.data(),
            static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), '\0') - bytes.begin())};
  }
  std::string printable() const { return udp::printable(view()); }
};

/// Command interface of the drives: positions (they follow CommandFrame::q_m), or torques (tau_m).
enum class Interface : std::uint32_t { kPosition = 1, kTorque = 2 };

/// Properties of a device on which both sides must agree.
struct Description {
  Text<64> device;  ///< name of the device in its device.yaml
  std::uint32_t n_p = 0;
  std::uint32_t n_m = 0;
  double rate_Hz = 0.0;
  Interface interface = Interface::kPosition;
  bool is_lock_step = false;  ///< each side waits for the other instead of for a clock
};

enum class Refusal : std::uint32_t {
  kNone = 0,
  kBusy = 1,      ///< another client has the device
  kProtocol = 2,  ///< other protocol version
  kMismatch = 3,  ///< descriptions differ
  kKey = 4,       ///< the tag of the shared key is wrong, missing or not expected
};

enum class Farewell : std::uint32_t {
  kDone = 1,    ///< as planned
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

struct Hello {
  std::uint64_t nonce = 0;
  Description expected;
  Text<64> client;
};

struct Welcome {
  std::uint64_t nonce = 0;
  Refusal refusal = Refusal::kNone;
  bool is_simulated = false;  ///< no machine moves, whatever is commanded
  Description actual;
  double command_timeout_s = 0.0;
  Text<64> server;
  Text<192> reason;
};

struct Ready {};

struct Goodbye {
  Farewell farewell = Farewell::kDone;
  Text<64> reason;
};

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
