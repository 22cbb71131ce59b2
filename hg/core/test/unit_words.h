// Units in notes: a field's unit is an argument of its own (hg/core/unit.h).
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace hg {

// First word of a note that is a unit; empty without one.
inline std::string unit_word_in(std::string_view note) {
  constexpr std::array<std::string_view, 32> kUnits = {
      "s",       "ms",    "us",      "ns",     "Hz",      "kHz",     "m",       "mm",
      "m/s",     "m/s^2", "rad",     "rad/s",  "rad/s^2", "deg",     "degrees", "radians",
      "N",       "Nm",    "N/cm^2",  "Ns/m",   "Nm/rad",  "N/m",     "J",       "kg",
      "Celsius", "degC",  "seconds", "metres", "meters",  "newtons", "SI",      "bytes"};
  constexpr std::string_view kBetween = " ,;:()[]=.";
  while (true) {
    const std::size_t begin = note.find_first_not_of(kBetween);
    if (begin == note.npos) return "";
    note.remove_prefix(begin);
    const std::string_view word = note.substr(0, note.find_first_of(kBetween));
    if (std::ranges::find(kUnits, word) != kUnits.end()) return std::string(word);
    note.remove_prefix(word.size());
  }
}

}  // namespace hg
