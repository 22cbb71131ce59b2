#include "hg/new/chain_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <ranges>
#include <vector>

#include "hg/model/chain_data.h"

namespace hg::new_files {

model::ChainModel read_part(const ChainPart& part) {
  model::ChainOptions options;
  options.root_link = part.root_link;
  options.tip_link = part.tip_link;
  return model::ChainModel::from_urdf_file(part.urdf, options);
}

namespace {

// Short hints are words of their own: "ee" is not in "screen".
bool is_named(const std::string& name, const std::string& hint) {
  const auto is_letter = [&](std::size_t i) {
    return i < name.size() && std::isalpha(static_cast<unsigned char>(name[i])) != 0;
  };
  const bool is_word = hint.size() <= 3;
  for (std::size_t at = name.find(hint); at != std::string::npos; at = name.find(hint, at + 1)) {
    if (!is_word || !(is_letter(at - 1) || is_letter(at + hint.size()))) return true;
  }
  return false;
}

// frames, in their order, that at least so many degrees of freedom move
std::vector<int> moved_frames(const model::ChainModel& chain, int degrees) {
  constexpr double kMoved = 1e-9;  // m or rad per rad or m
  model::ChainData data(chain);
  data.update_kinematics(chain.integrate(chain.neutral(), VectorA::Constant(chain.nv(), 0.3)),
                         VectorA::Zero(chain.nv()));
  std::vector<int> frames;
  for (std::size_t i = 0; i < chain.frame_names().size(); ++i) {
    const model::Jacobian& J = data.jacobian(static_cast<int>(i));
    if ((J.colwise().norm().array() > kMoved).count() >= degrees) {
      frames.push_back(static_cast<int>(i));
    }
  }
  return frames;
}

}  // namespace

int held_frame(const model::ChainModel& chain, int degrees) {
  constexpr std::array kHints = {"handle", "tcp",  "tool", "end_effector", "endeffector",
                                 "ee",     "grip", "hand", "flange"};
  const std::vector<int> frames = moved_frames(chain, degrees);
  for (const char* hint : kHints) {
    for (const int frame : std::views::reverse(frames)) {
      std::string name = chain.frame_names()[frame];
      std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
      if (is_named(name, hint)) return frame;
    }
  }
  return frames.empty() ? -1 : frames.back();
}

std::string rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return "0";
  const int digits = 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  const double scale = std::pow(10.0, digits);
  return fmt::format("{}", std::round(value * scale) / scale);
}

std::string quoted(const std::string& name) {
  constexpr std::array<const char*, 8> kWords = {"y",  "n",   "yes",  "no",
                                                 "on", "off", "true", "false"};
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '.' || c == '-';
  };
  std::string lower = name;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const bool is_word = std::ranges::find(kWords, lower) != kWords.end() || lower == "null";
  const bool begins_plain = !name.empty() && (std::isalpha(static_cast<unsigned char>(name[0])) ||
                                              name[0] == '_' || name[0] == '/' || name[0] == '.');
  if (begins_plain && !is_word && std::ranges::all_of(name, is_plain)) return name;
  std::string text;
  for (char c : name) text += c == '\'' ? std::string("''") : std::string(1, c);
  return "'" + text + "'";
}

std::string urdf_in(const ChainPart& part, const std::filesystem::path& folder) {
  const std::filesystem::path base = folder.empty() ? "." : folder;
  return std::filesystem::relative(part.urdf, base).generic_string();
}

std::string part_lines(const ChainPart& part, const std::filesystem::path& folder) {
  std::string text = fmt::format("urdf: {}\n", quoted(urdf_in(part, folder)));
  if (!part.root_link.empty()) text += fmt::format("root_link: {}\n", quoted(part.root_link));
  if (!part.tip_link.empty()) text += fmt::format("tip_link: {}\n", quoted(part.tip_link));
  return text;
}

}  // namespace hg::new_files
