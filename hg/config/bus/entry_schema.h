/// Description of process data and settings of a slave in machine.yaml.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "hg/config/schema.h"
#include "hg/device/ethercat/machine.h"

namespace hg::config {

inline constexpr std::uint32_t kMostObject = 0xFFFF;
inline constexpr std::uint32_t kMostSubindex = 0xFF;

/// Whether one of the entries has this meaning.
template <typename Meaning>
bool has_entry(const std::vector<ethercat::Entry<Meaning>>& entries, Meaning meaning) {
  return std::ranges::any_of(
      entries, [&](const ethercat::Entry<Meaning>& entry) { return entry.meaning == meaning; });
}

template <class V, typename Meaning>
void describe(V& v, ethercat::Entry<Meaning>& entry) {
  const auto meanings = choices_of<Meaning>();
  v.whole("object", entry.object, kMostObject, "index of the object that is mapped; 0: a gap");
  v.whole("subindex", entry.subindex, kMostSubindex, "its subindex");
  v.whole("bits", entry.bits, 32, "its size in the process data", Need::kRequired);
  v.choice("is", entry.meaning, Choices<Meaning>(meanings), "what it means");
  v.number(
      "scale", entry.scale, {.lb = -1e3, .ub = 1e3},
      "SI units (m, rad, Nm, N, degrees Celsius, per s, per s^2) per count, of what has a unit "
      "required; negative: the other way round");
  v.number("offset", entry.offset, {.lb = -1e3, .ub = 1e3}, "SI units at the number 0");
  v.flag("inverted", entry.is_inverted, "of a switch: 0 says yes");
  v.rule(entry.bits > 0, "bits", "must be 1 to 32");
  v.rule(v.is_given("scale") || !ethercat::is_measure(entry.meaning), "is",
         "needs a scale: how many SI units a count is");
  v.rule(entry.scale != 0.0, "scale", "must not be 0");
  v.rule(entry.object != 0 || entry.meaning == Meaning::kNothing, "is",
         "a gap (object 0) has no meaning");
}

template <class V>
void describe(V& v, ethercat::Setting& setting) {
  v.whole("object", setting.object, kMostObject, "index of the object", Need::kRequired);
  v.whole("subindex", setting.subindex, kMostSubindex, "its subindex");
  v.whole("bits", setting.bits, 32, "its size: 8, 16 or 32", Need::kRequired);
  v.number("value", setting.value, {.lb = -2147483648.0, .ub = 4294967295.0}, "a whole number",
           Need::kRequired);
  v.rule(setting.bits == 8 || setting.bits == 16 || setting.bits == 32, "bits",
         "must be 8, 16 or 32");
  v.rule(setting.value == static_cast<double>(static_cast<std::int64_t>(setting.value)), "value",
         "must be a whole number");
}

}  // namespace hg::config
