// An archive that fills a message with arbitrary bits: every field that is encoded gets its own.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <random>

#include "hg/core/types.h"
#include "hg/messages/message.h"

namespace hg::messages {

class RandomFiller {
 public:
  explicit RandomFiller(std::uint64_t seed) : random_(seed) {}

  template <HasFields T>
  void operator()(const char*, T& message, const char* = "", const Unit& = unit::kNone) {
    fields(*this, message);
  }

  void operator()(const char*, bool& value, const char* = "", const Unit& = unit::kNone) {
    value = random_() % 2 == 1;
  }

  template <IsScalar T>
  void operator()(const char*, T& value, const char* = "", const Unit& = unit::kNone) {
    const std::uint64_t bits = random_();
    std::memcpy(&value, &bits, sizeof(T));
  }

  template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  void operator()(const char* name,
                  Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>& matrix,
                  const char* = "", const Unit& = unit::kNone) {
    if constexpr (kRows == Eigen::Dynamic) matrix.resize(length_up_to(kMaxRows));
    for (Eigen::Index i = 0; i < matrix.size(); ++i) (*this)(name, matrix(i));
  }

  template <typename T, std::size_t kCapacity>
  void sequence(const char* name, std::array<T, kCapacity>& items, int& count, const char*) {
    count = length_up_to(kCapacity);
    for (int i = 0; i < count; ++i) (*this)(name, items[i]);
  }

 private:
  int length_up_to(std::size_t capacity) { return static_cast<int>(random_() % (capacity + 1)); }

  std::mt19937_64 random_;
};

}  // namespace hg::messages
