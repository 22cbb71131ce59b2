/// Messages as CDR bytes: the encoding of ROS 2.
///
/// Source: OMG Common Data Representation, plain CDR version 1, little endian: four header bytes
/// 00 01 00 00, then each number aligned to its own size, counted from behind the header; sequences
/// and strings start with a 32-bit length, strings end with a zero that their length includes.
/// Doubles keep all their bits. Writing allocates only while the buffer grows to its largest
/// message.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "hg/core/types.h"
#include "hg/messages/message.h"

namespace hg::messages {

static_assert(std::endian::native == std::endian::little);

inline constexpr std::array<std::byte, 4> kCdrHeader = {std::byte{0}, std::byte{1}, std::byte{0},
                                                        std::byte{0}};

/// Encodes one message at a time into a reused buffer.
class CdrWriter {
 public:
  /// Encodes a message; the bytes are valid until the next call.
  template <HasFields Message>
  std::span<const std::byte> encode(const Message& message) {
    size_ = 0;
    append(kCdrHeader.data(), kCdrHeader.size());
    put(message);
    return {buffer_.data(), size_};
  }

  template <typename T>
  void operator()(const char*, const T& value, const char* = "", const Unit& = unit::kNone) {
    put(value);
  }

  template <typename T, std::size_t kCapacity>
  void sequence(const char*, const std::array<T, kCapacity>& items, int count, const char*) {
    put(static_cast<std::uint32_t>(count));
    for (int i = 0; i < count; ++i) put(items[i]);
  }

 private:
  template <IsScalar T>
  void put(T value) {
    align(sizeof(T));
    append(&value, sizeof(T));
  }

  template <HasFields T>
  void put(const T& message) {
    fields(*this, message);
  }

  template <typename T>
  void put(const std::vector<T>& items) {
    put(static_cast<std::uint32_t>(items.size()));
    for (const T& item : items) put(item);
  }

  template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  void put(const Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>& matrix) {
    if constexpr (kRows == Eigen::Dynamic) put(static_cast<std::uint32_t>(matrix.size()));
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      for (Eigen::Index col = 0; col < matrix.cols(); ++col) put(matrix(row, col));
    }
  }

  void put(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    append(text.c_str(), text.size() + 1);
  }

  void align(std::size_t bytes) {
    static constexpr std::array<std::byte, 8> kZeros{};
    const std::size_t past = (size_ - kCdrHeader.size()) % bytes;
    if (past != 0) append(kZeros.data(), bytes - past);
  }

  void append(const void* data, std::size_t bytes) {
    if (size_ + bytes > buffer_.size()) buffer_.resize(2 * buffer_.size() + bytes);
    std::memcpy(buffer_.data() + size_, data, bytes);
    size_ += bytes;
  }

  std::vector<std::byte> buffer_ = std::vector<std::byte>(16 * 1024);
  std::size_t size_ = 0;
};

}  // namespace hg::messages
