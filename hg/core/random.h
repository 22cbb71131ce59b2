/// Random numbers that are the same with every standard library.
///
/// The distributions of <random> are not: published results must not depend on them.
#pragma once

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

}  // namespace hg
