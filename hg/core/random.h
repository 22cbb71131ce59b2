/// Random numbers that are the same with every standard library.
///
/// The distributions of <random> are not: published results must not depend on them.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace hg {

/// Random numbers of a seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Next number in [0, 1).
  double next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Next number in [from, to).
  double between(double from, double to) { return from + (to - from) * next(); }
  /// Next number of a normal distribution with mean 0 and variance 1, by Box and Muller.
  double normal() {
    const double length = std::sqrt(-2.0 * std::log1p(-next()));
    return length * std::cos(2.0 * std::numbers::pi * next());
  }

 private:
  std::mt19937_64 engine_;
};

/// Random numbers of the 32-bit engine, of which posture searches were published. New code uses
/// Random.
class Random32 {
 public:
  explicit Random32(std::uint32_t seed) : engine_(seed) {}

  /// Next number in [0, 1], both included.
  double next() { return static_cast<double>(engine_()) / 4294967295.0; }

 private:
  std::mt19937 engine_;
};

}  // namespace hg
