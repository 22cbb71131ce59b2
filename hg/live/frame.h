/// Frames of the live protocol: texts (JSON) and binary ones, whose numbers are little endian.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace hg::live {

static_assert(std::endian::native == std::endian::little);

/// Content of a frame; shared, because many clients get the same.
using Bytes = std::shared_ptr<const std::string>;

inline Bytes to_bytes(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

/// One message of a channel on its way to the clients.
struct Message {
  std::size_t channel = 0;    ///< index in channels()
  std::uint64_t time_ns = 0;  ///< since 1970
  Bytes payload;
};

/// A frame to one client.
struct Frame {
  bool is_text = true;
  std::string head;  ///< all of a text frame; the first bytes of a binary one
  Bytes payload;     ///< the rest of a binary frame; null = nothing

  std::size_t size() const { return head.size() + (payload ? payload->size() : 0); }
};

/// First byte of a binary frame from the server.
enum class ServerOp : std::uint8_t {
  kMessage = 1,
  kTime = 2,
  kServiceResponse = 3,
  kAssetResponse = 4,
};

/// First byte of a binary frame from a client.
enum class ClientOp : std::uint8_t { kMessage = 1, kServiceRequest = 2 };

template <std::unsigned_integral T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Takes a number from the front of `bytes`; false when they are too few.
template <std::unsigned_integral T>
[[nodiscard]] bool take(std::string_view& bytes, T& value) {
  if (bytes.size() < sizeof value) return false;
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return true;
}

inline std::string begin_frame(ServerOp op) {
  return std::string(1, static_cast<char>(static_cast<std::uint8_t>(op)));
}

}  // namespace hg::live
