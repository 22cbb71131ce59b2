/// Which side of a session sends which messages.
#pragma once

#include <cstdint>

#include "hg/device/udp/protocol.h"

namespace hg::udp {

/// The side of a session that asks for it, and the one that serves it.
enum class Side : std::uint8_t { kClient, kServer };

/// Whether this side sends messages of this type.
constexpr bool sends(Side side, MessageType type) noexcept {
  switch (type) {
    case MessageType::kHello:
    case MessageType::kReady:
    case MessageType::kCommand:
    case MessageType::kTerms:
    case MessageType::kLeader:
      return side == Side::kClient;
    case MessageType::kWelcome:
    case MessageType::kSensors:
    case MessageType::kRoundTrip:
    case MessageType::kRemote:
      return side == Side::kServer;
    case MessageType::kGoodbye:
      return true;
  }
  return false;
}

}  // namespace hg::udp
