/// Free space with parts of the machine changed or switched off, to show their contribution.
/// Source: [C] 4. The measure is that of free_space.h.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/haptify/free_space.h"
#include "hg/experiments/workers.h"

namespace hg::haptify {

/// Gantry vibration unknown to the observer: added to the drive commands, so that the acceleration
/// rotates with this magnitude.
struct GantryVibration {
  double acceleration = 0.0;  ///< m/s^2; 0 = none
  double frequency_Hz = 12.0;
};

/// Adds the vibration to the commands of drives with this lag, so that the wanted acceleration
/// results.
void shake(const GantryVibration& vibration, double lag, double time_s, VectorP& dq_p) noexcept;

/// Part of a device without which a variant changes nothing.
enum class Needs {
  kNothing,
  kElasticJoints,  ///< motors behind springs and friction, controlled by their torques
  kGantry,
  kInertialUnit,
};

struct FreeSpaceVariant {
  std::string name;
  std::function<void(config::Scenario&)> change;
  bool takes_away = false;         ///< an imperfection is removed: the improvement is its share
  GantryVibration vibration = {};  ///< added vibration of the gantry
  Needs needs = Needs::kNothing;
};

/// Why the device cannot play the variant, with experiments::kNotPossible; empty = it can.
std::string no_variant(const config::SimulatedDeviceConfig& device,
                       const FreeSpaceVariant& variant);

/// Variants to play; the first one is the unchanged scenario.
std::vector<FreeSpaceVariant> free_space_variants();

/// Measures free space with one change.
FreeSpace measure_variant(const config::Scenario& scenario, const FreeSpaceVariant& variant,
                          const FreeSpaceConfig& config, std::uint64_t seed);

struct FreeSpaceRun {
  std::string name;
  bool takes_away = false;
  FreeSpace measured;
};

/// Measures all variants, on all cores, in the box of place_of() the device; see place.h.
std::vector<FreeSpaceRun> measure_variants(const config::Scenario& scenario,
                                           const FreeSpaceConfig& config, std::uint64_t seed,
                                           const experiments::Progress& progress);

nlohmann::ordered_json to_json(const std::vector<FreeSpaceRun>& runs);

}  // namespace hg::haptify
