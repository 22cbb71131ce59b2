#include "hg/simulator/person/tremor.h"

#include <cmath>
#include <numbers>

namespace hg::person {
namespace {

constexpr double kLowest_Hz = 8.0, kHighest_Hz = 12.0;  // [HANDBOOK] 5.1

// splitmix64: the next number of a seed, in [0, 1)
double next(std::uint64_t& seed) noexcept {
  seed += 0x9E3779B97F4A7C15u;
  std::uint64_t z = seed;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-53;
}

}  // namespace

// the power of a sine is half the square of its amplitude
Tremor::Tremor(double rms, std::uint64_t seed) noexcept
    : amplitude_(rms * std::sqrt(2.0 / kSines)) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  constexpr double kSpacing_Hz = (kHighest_Hz - kLowest_Hz) / kSines;
  for (auto& axis : sines_) {
    double lowest_Hz = kLowest_Hz;
    for (Sine& sine : axis) {
      sine = {kTurn * (lowest_Hz + kSpacing_Hz * next(seed)), kTurn * next(seed)};
      lowest_Hz += kSpacing_Hz;
    }
  }
}

Eigen::Vector3d Tremor::force(double t) const noexcept {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  if (amplitude_ == 0.0) return force;
  for (std::size_t axis = 0; axis < sines_.size(); ++axis) {
    double sum = 0.0;
    for (const Sine& sine : sines_[axis]) sum += std::sin(sine.omega * t + sine.phase);
    force[axis] = amplitude_ * sum;
  }
  return force;
}

}  // namespace hg::person
