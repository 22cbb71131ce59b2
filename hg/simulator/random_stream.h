/// Random numbers for a simulation: one independent stream per effect and channel.
///
/// The k-th number depends on the seed, the stream and k only, so switching one effect off or on
/// leaves all others as they were. Uniform: SplitMix64 [Steele 2014] as a counter; Gaussian:
/// Box-Muller. Copyable, no allocation, bounded.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace hg::simulator {

/// Effects with random numbers of their own. Recorded runs depend on them: never renumber.
enum class RandomEffect : std::uint64_t {
  kLinkEncoder = 1,
  kMotorEncoder = 2,
  kGantryEncoder = 3,
  kTorqueNoise = 4,
  kTorqueErrors = 5,
  kWrenchNoise = 6,
  kWrenchErrors = 7,
  kWrenchWalk = 8,
  kTemperature = 9,
  kAccelerometerNoise = 10,
  kAccelerometerErrors = 11,
  kAccelerometerDrift = 12,
  kGyroscopeNoise = 13,
  kGyroscopeErrors = 14,
  kGyroscopeDrift = 15,
  kCogging = 16,
  kRipple = 17,
  kWaviness = 18,
  kLinkAccelerometerNoise = 19,
  kLinkAccelerometerErrors = 20,
  kLinkAccelerometerDrift = 21,
  kLinkGyroscopeNoise = 22,
  kLinkGyroscopeErrors = 23,
  kLinkGyroscopeDrift = 24,
  kLinkMounting = 25,
  kTorqueEstimate = 26,
};

class RandomStream {
 public:
  RandomStream() = default;
  /// `channel`: joint or axis, 0..255.
  RandomStream(std::uint64_t seed, RandomEffect effect, int channel = 0) noexcept
      : state_(mixed(mixed(seed) + mixed(static_cast<std::uint64_t>(effect) * 256 +
                                         static_cast<std::uint64_t>(channel)))) {}

  /// Uniformly distributed number in [0, 1).
  double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }

  /// Gaussian number with mean 0, variance 1.
  double gaussian() noexcept {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;

  static constexpr std::uint64_t mixed(std::uint64_t z) noexcept {
    z += kGolden;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  std::uint64_t next() noexcept {
    const std::uint64_t value = mixed(state_);
    state_ += kGolden;
    return value;
  }

  std::uint64_t state_ = 0;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace hg::simulator
