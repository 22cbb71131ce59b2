#include "hg/scaffold/chain_part.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace hg::scaffold {

model::Chain read_part(const ChainPart& part) { return model::Chain::from_urdf_file(part.urdf); }

int held_frame(const model::Chain& chain) {
  constexpr std::array<const char*, 6> kHints = {"handle", "tcp", "tool", "ee", "grip", "hand"};
  const auto& names = chain.frame_names();
  for (const char* hint : kHints) {
    for (std::size_t i = names.size(); i-- > 0;) {
      if (names[i].find(hint) != std::string::npos) return static_cast<int>(i);
    }
  }
  return static_cast<int>(names.size()) - 1;
}

std::string rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return "0";
  const int digits = 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  const double scale = std::pow(10.0, digits);
  return fmt::format("{}", std::round(value * scale) / scale);
}

std::string part_lines(const ChainPart& part, const std::filesystem::path& folder) {
  const std::filesystem::path base = folder.empty() ? "." : folder;
  std::string text =
      fmt::format("urdf: {}\n", std::filesystem::relative(part.urdf, base).generic_string());
  if (!part.root_link.empty()) text += fmt::format("root_link: {}\n", part.root_link);
  if (!part.tip_link.empty()) text += fmt::format("tip_link: {}\n", part.tip_link);
  return text;
}

}  // namespace hg::scaffold
