#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "hg/device/udp/codec.h"
#include "hg/device/udp/round_trip.h"
#include "hg/device/udp/teleoperation_messages.h"
#include "tests/fuzz/targets.h"

namespace hg::fuzz {
namespace {

using namespace udp;

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

// What was decoded says the same after another way over the wire.
template <typename Message>
void go_round(std::span<const std::byte> datagram, const Header& header) {
  if (datagram.size() != size_of<Header>() + size_of<Message>() + 4) fail("another length");
  const auto message = std::make_unique<Message>();
  if (!decode(datagram, *message)) return;
  Datagram again;
  encode(header, *message, again);
  if (again.size != datagram.size() ||
      std::memcmp(again.bytes.data(), datagram.data(), again.size) != 0) {
    fail("other bytes after decoding and encoding");
  }
}

}  // namespace

void protocol(Bytes bytes) {
  if (bytes.empty()) return;
  std::vector<std::byte> datagram;
  for (const std::uint8_t byte : bytes.subspan(1)) datagram.push_back(std::byte{byte});
  if (bytes[0] % 2 == 1 && datagram.size() >= 4) {
    const std::uint32_t crc = checksum(std::span(datagram).first(datagram.size() - 4));
    std::memcpy(datagram.data() + datagram.size() - 4, &crc, sizeof crc);
  }
  Header header;
  if (read_header(datagram, header) != DatagramCheck::kGood) return;
  switch (static_cast<MessageType>(header.type)) {
    case MessageType::kHello:
      return go_round<Hello>(datagram, header);
    case MessageType::kWelcome:
      return go_round<Welcome>(datagram, header);
    case MessageType::kReady:
      return go_round<Ready>(datagram, header);
    case MessageType::kSensors:
      return go_round<SensorFrame>(datagram, header);
    case MessageType::kCommand:
      return go_round<CommandFrame>(datagram, header);
    case MessageType::kGoodbye:
      return go_round<Goodbye>(datagram, header);
    case MessageType::kRoundTrip:
      return go_round<RoundTrip>(datagram, header);
    case MessageType::kTerms:
      return go_round<Terms>(datagram, header);
    case MessageType::kLeader:
      return go_round<LeaderMessage>(datagram, header);
    case MessageType::kRemote:
      return go_round<RemoteMessage>(datagram, header);
  }
  fail("a good header of no message");
}

}  // namespace hg::fuzz
