#include "hg/device/udp/codec.h"

#include <zlib.h>

#include "hg/device/udp/round_trip.h"
#include "hg/device/udp/teleoperation_messages.h"

namespace hg::udp {
namespace {

const std::size_t kHeaderSize = size_of<Header>();
constexpr std::size_t kChecksumSize = 4;

// size of the whole datagram; 0: no such type
std::size_t length_of(std::uint16_t type) noexcept {
  const auto with = [](std::size_t fields) { return kHeaderSize + fields + kChecksumSize; };
  switch (static_cast<MessageType>(type)) {
    case MessageType::kHello:
      return with(size_of<Hello>());
    case MessageType::kWelcome:
      return with(size_of<Welcome>());
    case MessageType::kReady:
      return with(size_of<Ready>());
    case MessageType::kSensors:
      return with(size_of<SensorFrame>());
    case MessageType::kCommand:
      return with(size_of<CommandFrame>());
    case MessageType::kGoodbye:
      return with(size_of<Goodbye>());
    case MessageType::kRoundTrip:
      return with(size_of<RoundTrip>());
    case MessageType::kTerms:
      return with(size_of<Terms>());
    case MessageType::kLeader:
      return with(size_of<LeaderMessage>());
    case MessageType::kRemote:
      return with(size_of<RemoteMessage>());
  }
  return 0;
}

}  // namespace

std::uint32_t checksum(std::span<const std::byte> bytes) noexcept {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

DatagramCheck read_header(std::span<const std::byte> datagram, Header& header,
                          const Key& key) noexcept {
  if (datagram.size() < kHeaderSize + kChecksumSize) return DatagramCheck::kTruncated;
  Decoder decoder(datagram.data());
  layout(decoder, header);
  if (header.magic != kMagic) return DatagramCheck::kForeign;
  if (header.length != datagram.size()) return DatagramCheck::kTruncated;
  std::uint32_t crc = 0;
  std::memcpy(&crc, datagram.data() + datagram.size() - kChecksumSize, sizeof crc);
  if (crc != checksum(datagram.first(datagram.size() - kChecksumSize)))
    return DatagramCheck::kCorrupted;
  if (header.version != kVersion) return DatagramCheck::kWrongVersion;
  const std::size_t length = length_of(header.type);
  if (length == 0) return DatagramCheck::kForeign;
  const bool has_tag = datagram.size() == length + Key::kTagSize;
  if (!has_tag && datagram.size() != length) return DatagramCheck::kTruncated;
  if (has_tag != key.is_set()) return DatagramCheck::kForged;
  if (!has_tag) return DatagramCheck::kGood;
  const std::size_t tagged = length - kChecksumSize;
  return key.fits(datagram.first(tagged), datagram.subspan(tagged).first<Key::kTagSize>())
             ? DatagramCheck::kGood
             : DatagramCheck::kForged;
}

}  // namespace hg::udp
