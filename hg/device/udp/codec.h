/// Messages to datagrams and back: header, fields, the tag of a shared key if there is one, CRC-32
/// (as zlib has it) over all of them.
///
/// No allocation, noexcept. Untrusted bytes may be decoded: no read goes beyond them.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "hg/core/types.h"
#include "hg/device/udp/key.h"
#include "hg/device/udp/layout.h"

namespace hg::udp {

static_assert(std::endian::native == std::endian::little);

struct Datagram {
  std::array<std::byte, kLargestDatagram> bytes;
  std::size_t size = 0;
  std::span<const std::byte> view() const noexcept { return {bytes.data(), size}; }
};

/// Appends fields to a buffer; the caller provides enough room.
class Encoder {
 public:
  static constexpr bool kIgnoresText = true;
  explicit Encoder(std::byte* to) : begin_(to), at_(to) {}
  std::size_t size() const noexcept { return at_ - begin_; }

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const char*, T value, const char*, const Unit& = unit::kNone) noexcept {
    if constexpr (std::is_enum_v<T> || std::same_as<T, bool>) {
      put(static_cast<std::uint32_t>(value));
    } else {
      put(value);
    }
  }
  template <std::size_t kSize>
  void operator()(const char*, const Text<kSize>& text, const char*,
                  const Unit& = unit::kNone) noexcept {
    put(text.bytes);
  }
  template <int kRows, int kOptions, int kMaxRows>
  void operator()(const char*, const Eigen::Matrix<double, kRows, 1, kOptions, kMaxRows, 1>& v,
                  const char*, const Unit& = unit::kNone) noexcept {
    if constexpr (kRows == Eigen::Dynamic) {
      put(static_cast<std::uint32_t>(v.size()));
      zeros("");
    }
    for (int i = 0; i < kMaxRows; ++i) put(i < v.size() ? v[i] : 0.0);
  }
  void zeros(const char*) noexcept { put(std::uint32_t{0}); }

 private:
  template <typename T>
  void put(const T& value) noexcept {
    std::memcpy(at_, &value, sizeof(T));
    at_ += sizeof(T);
  }
  std::byte* begin_;
  std::byte* at_;
};

/// Reads fields in their order; the caller provides enough bytes.
class Decoder {
 public:
  static constexpr bool kIgnoresText = true;
  explicit Decoder(const std::byte* from) : begin_(from), at_(from) {}
  std::size_t size() const noexcept { return at_ - begin_; }
  /// Whether every count, truth value and unused field had an allowed value.
  bool is_good() const noexcept { return is_good_; }

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const char*, T& value, const char*, const Unit& = unit::kNone) noexcept {
    if constexpr (std::same_as<T, bool>) {
      const auto number = take<std::uint32_t>();
      require(number <= 1);
      value = number != 0;
    } else if constexpr (std::is_enum_v<T>) {
      const auto number = take<std::uint32_t>();
      value = static_cast<T>(number);
      require(static_cast<std::uint32_t>(value) == number);
    } else {
      value = take<T>();
    }
  }
  template <std::size_t kSize>
  void operator()(const char*, Text<kSize>& text, const char*, const Unit& = unit::kNone) noexcept {
    text.bytes = take<std::array<char, kSize>>();
  }
  template <int kRows, int kOptions, int kMaxRows>
  void operator()(const char*, Eigen::Matrix<double, kRows, 1, kOptions, kMaxRows, 1>& v,
                  const char*, const Unit& = unit::kNone) noexcept {
    if constexpr (kRows == Eigen::Dynamic) {
      const auto count = take<std::uint32_t>();
      zeros("");
      require(count <= kMaxRows);
      v.resize(count <= kMaxRows ? static_cast<int>(count) : 0);
    }
    for (int i = 0; i < kMaxRows; ++i) {
      const auto value = take<double>();
      if (i < v.size()) {
        v[i] = value;
      } else {
        require(std::bit_cast<std::uint64_t>(value) == 0);  // not -0.0 either
      }
    }
  }
  void zeros(const char*) noexcept { require(take<std::uint32_t>() == 0); }

 private:
  template <typename T>
  T take() noexcept {
    T value;
    std::memcpy(&value, at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  void require(bool holds) noexcept { is_good_ = is_good_ && holds; }

  const std::byte* begin_;
  const std::byte* at_;
  bool is_good_ = true;
};

/// Size of the fields of a message, bytes.
template <typename Message>
std::size_t size_of() noexcept {
  std::array<std::byte, kLargestDatagram> room;
  Encoder encoder(room.data());
  const Message message{};
  layout(encoder, message);
  return encoder.size();
}

/// Result of checking a datagram, in the order of the checks.
enum class DatagramCheck {
  kGood,
  kTruncated,     ///< shorter than any message, or its length differs from its header or its type
  kForeign,       ///< another magic, or a type that does not exist
  kCorrupted,     ///< checksum mismatch
  kWrongVersion,  ///< other protocol version; only header and checksum are understood
  kForged,  ///< tag that does not match the key, missing despite a key, or present without one
};

/// CRC-32 of ISO-HDLC, the one of zlib, zip and PNG.
std::uint32_t checksum(std::span<const std::byte> bytes) noexcept;

/// Checks everything but the fields of the message; `header` is filled in unless kTruncated.
DatagramCheck read_header(std::span<const std::byte> datagram, Header& header,
                          const Key& key = {}) noexcept;

/// Encodes a message; fills in type and length of `header`, the tag and the checksum.
template <typename Message>
void encode(Header header, const Message& message, Datagram& datagram,
            const Key& key = {}) noexcept {
  static_assert(sizeof(Message) + 256 < kLargestDatagram);
  const std::size_t tag_size = key.is_set() ? Key::kTagSize : 0;
  Encoder encoder(datagram.bytes.data());
  header.type = static_cast<std::uint16_t>(kTypeOf<Message>);
  header.length = static_cast<std::uint32_t>(size_of<Header>() + size_of<Message>() + tag_size + 4);
  layout(encoder, header);
  layout(encoder, message);
  std::size_t size = encoder.size();
  if (key.is_set()) {
    const Key::Tag tag = key.tag({datagram.bytes.data(), size});
    std::memcpy(datagram.bytes.data() + size, tag.data(), tag.size());
    size += tag.size();
  }
  const std::uint32_t crc = checksum({datagram.bytes.data(), size});
  std::memcpy(datagram.bytes.data() + size, &crc, sizeof crc);
  datagram.size = size + sizeof crc;
}

/// Decodes the fields of a datagram of this type that read_header() found good. False: impossible
/// content, `message` must not be used.
template <typename Message>
[[nodiscard]] bool decode(std::span<const std::byte> datagram, Message& message) noexcept {
  Decoder decoder(datagram.data() + size_of<Header>());
  layout(decoder, message);
  return decoder.is_good();
}

}  // namespace hg::udp
