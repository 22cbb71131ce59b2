/// Random numbers that are the same with every standard library.
///
/// The distributions of <random> are not: published results must not depend on them.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace hg {

/// Uniform random numbers of a seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Next number in [0, 1).
  double next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Next number in [from, to).
  double between(double from, double to) { return from + (to - from) * next(); }

 private:
  std::mt19937_64 engine_;
};

/// Random numbers of a seed of 32 bits: those that std::mt19937 has with the distributions of GCC.
class Random32 {
 public:
  explicit Random32(std::uint32_t seed) : engine_(seed) {}

  /// Next number in [0, 1], of 32 bits.
  double share() { return static_cast<double>(engine_()) / 4294967295.0; }
  /// Next number in [0, 1).
  double next() {
    const auto low = static_cast<double>(engine_());
    const double number = (low + 0x1p32 * static_cast<double>(engine_())) * 0x1p-64;
    return number < 1.0 ? number : 1.0 - 0x1p-53;
  }
  /// Next number in [from, to).
  double between(double from, double to) { return from + (to - from) * next(); }
  /// Next number of mean 0 and standard deviation 1: polar method of Marsaglia, which makes two.
  double normal() {
    if (has_second_) {
      has_second_ = false;
      return second_;
    }
    double x = 0.0, y = 0.0, square = 0.0;
    do {
      x = 2.0 * next() - 1.0;
      y = 2.0 * next() - 1.0;
      square = x * x + y * y;
    } while (square > 1.0 || square == 0.0);
    const double scale = std::sqrt(-2.0 * std::log(square) / square);
    second_ = x * scale;
    has_second_ = true;
    return y * scale;
  }

 private:
  std::mt19937 engine_;
  double second_ = 0.0;
  bool has_second_ = false;
};

}  // namespace hg
