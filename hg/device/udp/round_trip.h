/// The message by which a device in real time reports how late commands come.
#pragma once

#include "hg/device/udp/protocol.h"

namespace hg::udp {

struct RoundTrip {
  double mean_s = 0.0;
};

template <typename Archive, Is<RoundTrip> T>
void fields(Archive& a, T& trip) {
  a("mean_s", trip.mean_s, "from a frame to the arrival of its command, mean of 0.1 s", unit::kS);
}

template <>
inline constexpr MessageType kTypeOf<RoundTrip> = MessageType::kRoundTrip;

}  // namespace hg::udp
