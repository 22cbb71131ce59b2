/// What the profile of drives (CiA 402) says of entries of machine.yaml.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace hg::config {

/// Bits of an object by CiA 402; 0: the profile has no such one.
inline std::uint32_t bits_by_profile(std::uint32_t object) {
  switch (object) {
    case 0x6060:
    case 0x6061:
      return 8;
    case 0x603F:
    case 0x6040:
    case 0x6041:
    case 0x6071:
    case 0x6072:
    case 0x6077:
      return 16;
    case 0x6064:
    case 0x606C:
    case 0x607A:
    case 0x60FF:
      return 32;
    default:
      return 0;
  }
}

template <class V>
void check_bits(V& v, const auto& entries, const std::string& key) {
  for (const auto& entry : entries) {
    const std::uint32_t bits = bits_by_profile(entry.object);
    v.rule(bits == 0 || entry.bits == bits, key,
           fmt::format("object 0x{:04X} has {} bits by CiA 402", entry.object, bits),
           std::to_string(entry.bits));
  }
}

}  // namespace hg::config
