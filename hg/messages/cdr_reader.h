/// Decodes messages from CDR bytes; see cdr_writer.h for the format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "hg/core/types.h"
#include "hg/messages/cdr_writer.h"
#include "hg/messages/message.h"

namespace hg::messages {

/// Decodes one message. A message of fixed capacity, such as a sample, needs no allocation.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// False when the bytes end too early, are not little-endian CDR, or a length exceeds a capacity;
  /// then `message` is only partly filled.
  template <HasFields Message>
  [[nodiscard]] bool decode(Message& message) {
    std::array<std::byte, 4> header{};
    take(header.data(), header.size());
    is_ok_ = is_ok_ && header == kCdrHeader;
    get(message);
    return is_ok_;
  }

  template <typename T>
  void operator()(const char*, T& value, const char* = "", const Unit& = unit::kNone) {
    get(value);
  }

  template <typename T, std::size_t kCapacity>
  void sequence(const char*, std::array<T, kCapacity>& items, int& count, const char*) {
    count = static_cast<int>(get_length(kCapacity));
    for (int i = 0; i < count; ++i) get(items[i]);
  }

 private:
  template <IsScalar T>
  void get(T& value) {
    const std::size_t past = (position_ - kCdrHeader.size()) % sizeof(T);
    if (past != 0) position_ += sizeof(T) - past;
    take(&value, sizeof(T));
  }

  void get(std::string& text) {
    const std::size_t length = get_length(bytes_.size());  // with the terminating zero
    is_ok_ = is_ok_ && length > 0;
    if (!is_ok_) return;
    text.resize(length);
    take(text.data(), length);
    text.pop_back();
  }

  template <HasFields T>
  void get(T& message) {
    fields(*this, message);
  }

  // an item at a time, so that a length that is not true costs no memory
  template <typename T>
  void get(std::vector<T>& items) {
    const std::size_t count = get_length(bytes_.size());
    items.clear();
    for (std::size_t i = 0; i < count && is_ok_; ++i) get(items.emplace_back());
  }

  template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  void get(Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>& matrix) {
    if constexpr (kRows == Eigen::Dynamic) matrix.resize(get_length(kMaxRows));
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      for (Eigen::Index col = 0; col < matrix.cols(); ++col) get(matrix(row, col));
    }
  }

  std::uint32_t get_length(std::size_t capacity) {
    std::uint32_t length = 0;
    get(length);
    is_ok_ = is_ok_ && length <= capacity;
    return is_ok_ ? length : 0;
  }

  void take(void* data, std::size_t bytes) {
    is_ok_ = is_ok_ && position_ + bytes <= bytes_.size();
    if (is_ok_) std::memcpy(data, bytes_.data() + position_, bytes);
    position_ += bytes;
  }

  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
  bool is_ok_ = true;
};

}  // namespace hg::messages
