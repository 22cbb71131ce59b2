/// Force and vibration at the handle on a slow walk in free space, with parts of the machine
/// changed or switched off to show their contribution. Source: [C] 4.
#pragma once

#include <functional>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/scenario.h"
#include "hg/studies/motion_analysis.h"
#include "hg/studies/workers.h"

namespace hg::studies {

/// Gantry vibration unknown to the observer: added to the drive commands, so that the acceleration
/// rotates with this magnitude.
struct GantryVibration {
  double acceleration = 0.0;  ///< m/s^2; 0 = none
  double frequency_Hz = 12.0;
};

/// Adds the vibration to the commands of drives with this lag, so that the wanted acceleration
/// results.
void shake(const GantryVibration& vibration, double lag, double time_s, VectorP& dq_p) noexcept;

/// Published figures of another source; NaN = not given.
struct FeelElsewhere {
  double force = kUnknown, own_share = kUnknown, extra = kUnknown;
  double vibration_5 = kUnknown, vibration_20 = kUnknown, centroid_Hz = kUnknown;
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

/// Table III of the paper; force and vibration may contain things that [HANDBOOK] 7 can only guess.
inline constexpr FeelElsewhere kPaperFeel = {
    .force = 1.28, .vibration_20 = 0.81, .centroid_Hz = 77.3};

struct FreeSpaceVariant {
  std::string name;
  std::function<void(config::Scenario&)> change;
  FeelElsewhere notes;      ///< figures of [C] 4
  bool takes_away = false;  ///< an imperfection is removed: the improvement is its contribution
  GantryVibration vibration = {};  ///< added vibration of the gantry
};

/// Variants to play; the first one is the unchanged scenario.
std::vector<FreeSpaceVariant> free_space_variants();

struct FreeSpaceRun {
  std::string name;
  Feel feel;
  FeelElsewhere notes;
  bool takes_away = false;
  double judged_s = 0.0;       ///< evaluated time of the walk, s; 0 = no walk took place
  double joint_error = 0.0;    ///< largest difference of reference and true link, rad
  double hand_distance = 0.0;  ///< largest distance of true handle and twin, m
  double torque_share = 0.0;   ///< largest motor torque over its peak
  FaultCode fault = FaultCode::kNone;
};

/// Plays one variant of `scenario`, a slow walk with a free twin. The first `settling` seconds
/// after the grasp, in which the person starts to walk, do not count.
FreeSpaceRun walk(const config::Scenario& scenario, const FreeSpaceVariant& variant,
                  double settling = 2.0);

/// Plays all variants, on all cores.
std::vector<FreeSpaceRun> measure_free_space(const config::Scenario& scenario,
                                             const Progress& progress);

/// Table with the paper's and the notes' figures, and the dominating contribution.
std::string to_text(const std::vector<FreeSpaceRun>& runs);
nlohmann::ordered_json to_json(const std::vector<FreeSpaceRun>& runs);

}  // namespace hg::studies
