/// Names of the law's presets and of its parts, and of the passivity reactions, in device.yaml and
/// on the command line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hg/config/schema.h"
#include "hg/controller/rendering/options.h"
#include "hg/controller/safety/passivity/passivity.h"

namespace hg::config {

/// Named combinations of law, bounds, gantry guidance and braking; docs/concepts/law.md.
enum class LawPreset : std::uint8_t {
  kTogether,     ///< Gauss' principle, recoverable bounds, limits that brake together
  kGauss,        ///< the same with limits that brake alone
  kGantry,       ///< gauss with the accelerations of the gantry as unknowns
  kPaper,        ///< the law of [HG] with recoverable bounds
  kPaperBounds,  ///< law and bounds of [HG]
};

inline constexpr auto kLawPresets = choices_of<LawPreset>();
inline constexpr auto kBounds = choices_of<rendering::Bounds>();
inline constexpr auto kGantries = choices_of<rendering::Gantry>();
inline constexpr auto kBrakings = choices_of<rendering::Braking>();
inline constexpr auto kPassivityReactions = choices_of<passivity::Reaction>();

struct LawParts {
  rendering::Law law = rendering::Law::kGauss;
  rendering::Bounds bounds = rendering::Bounds::kRecoverable;
  rendering::Gantry gantry = rendering::Gantry::kRule;
  rendering::Braking braking = rendering::Braking::kTogether;

  bool operator==(const LawParts&) const = default;
};

/// The parts of each preset, in the order of LawPreset.
inline constexpr std::array<LawParts, kLawPresets.size()> kPartsOfPresets = {
    {{},
     {.braking = rendering::Braking::kAlone},
     {.gantry = rendering::Gantry::kLaw, .braking = rendering::Braking::kAlone},
     {.law = rendering::Law::kPaper, .braking = rendering::Braking::kAlone},
     {.law = rendering::Law::kPaper,
      .bounds = rendering::Bounds::kPaper,
      .braking = rendering::Braking::kAlone}}};

constexpr void set_parts(rendering::RenderingOptions& options, LawPreset preset) noexcept {
  const LawParts& parts = kPartsOfPresets[static_cast<std::size_t>(preset)];
  options.law = parts.law;
  options.bounds = parts.bounds;
  options.gantry = parts.gantry;
  options.braking = parts.braking;
}

/// Name of the preset with these parts; empty where they are another combination.
constexpr std::string_view preset_name(const rendering::RenderingOptions& options) noexcept {
  const LawParts parts = {options.law, options.bounds, options.gantry, options.braking};
  for (std::size_t i = 0; i < kLawPresets.size(); ++i) {
    if (kPartsOfPresets[i] == parts) return kLawPresets[i].name;
  }
  return {};
}

}  // namespace hg::config
