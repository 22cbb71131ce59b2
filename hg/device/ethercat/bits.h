/// Numbers of any size in process data, little endian. No allocation, noexcept.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace hg::ethercat {

/// The number of `count` bits, 1 to 32, from bit `first` on. Bits beyond the data are 0.
inline std::uint32_t read_bits(std::span<const std::uint8_t> data, std::uint32_t first,
                               std::uint32_t count) noexcept {
  std::uint64_t value = 0;
  const std::size_t byte = first / 8;
  for (std::size_t i = 0; i < 5 && byte + i < data.size(); ++i) {
    value |= std::uint64_t{data[byte + i]} << (8 * i);
  }
  return static_cast<std::uint32_t>(value >> (first % 8) & ((std::uint64_t{1} << count) - 1));
}

/// The same number with a sign.
inline std::int32_t signed_of(std::uint32_t value, std::uint32_t count) noexcept {
  const std::uint32_t shift = 32 - count;
  return static_cast<std::int32_t>(value << shift) >> shift;
}

/// Puts a number of `count` bits there; other bits stay.
inline void write_bits(std::span<std::uint8_t> data, std::uint32_t first, std::uint32_t count,
                       std::uint32_t value) noexcept {
  const std::size_t byte = first / 8;
  const std::uint64_t mask = ((std::uint64_t{1} << count) - 1) << (first % 8);
  const std::uint64_t bits = std::uint64_t{value} << (first % 8) & mask;
  for (std::size_t i = 0; i < 5 && byte + i < data.size(); ++i) {
    const auto keep = static_cast<std::uint8_t>(~(mask >> (8 * i)));
    data[byte + i] = static_cast<std::uint8_t>((data[byte + i] & keep) | (bits >> (8 * i) & 0xFF));
  }
}

/// The nearest number with a sign of `count` bits, where too large ones become the largest.
inline std::uint32_t rounded(double value, std::uint32_t count) noexcept {
  const double most = std::ldexp(1.0, static_cast<int>(count) - 1);
  const double limited = std::clamp(std::nearbyint(value), -most, most - 1.0);
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(limited));
}

}  // namespace hg::ethercat
