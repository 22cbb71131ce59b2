/// How free free space feels: force and vibration at the handle on a slow walk, with parts of the
/// machine changed or switched off to see what they contribute. Source: [C] 4.
#pragma once

#include <functional>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/scenario.h"
#include "hg/experiments/motion_analysis.h"
#include "hg/experiments/workers.h"

namespace hg::experiments {

/// A vibration of the gantry that its observer knows nothing of: put onto the commands of its
/// drives, so that their accelerations turn with this magnitude.
struct GantryVibration {
  double acceleration = 0.0;  ///< m/s^2; 0 = none
  double frequency_Hz = 12.0;
};

/// Adds to the commands of drives with this lag what they turn into the wanted acceleration.
void shake(const GantryVibration& vibration, double lag, double time_s, VectorP& dq_p) noexcept;

/// What somebody else found; NaN = not said.
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
  FeelElsewhere notes;             ///< of [C] 4
  bool takes_away = false;         ///< an imperfection: what becomes better is its contribution
  GantryVibration vibration = {};  ///< of the gantry
};

/// The variants that are played; the first one is the scenario as it is.
std::vector<FreeSpaceVariant> free_space_variants();

struct FreeSpaceRun {
  std::string name;
  Feel feel;
  FeelElsewhere notes;
  bool takes_away = false;
  double judged_s = 0.0;       ///< of the walk; 0: it did not come to a walk
  double joint_error = 0.0;    ///< largest difference of reference and true link, rad
  double hand_distance = 0.0;  ///< largest of true handle and twin, m
  double torque_share = 0.0;   ///< largest of a motor over its peak
  FaultCode fault = FaultCode::kNone;
};

/// `scenario`: a slow walk with a free twin. The first `settling` seconds after the grasp, in which
/// the person starts to walk, do not count.
FreeSpaceRun walk(const config::Scenario& scenario, const FreeSpaceVariant& variant,
                  double settling = 2.0);

/// All variants, on all cores.
std::vector<FreeSpaceRun> measure_free_space(const config::Scenario& scenario,
                                             const Progress& progress);

/// A table beside the paper's and the notes' figures, and what dominates.
std::string to_text(const std::vector<FreeSpaceRun>& runs);
nlohmann::ordered_json to_json(const std::vector<FreeSpaceRun>& runs);

}  // namespace hg::experiments
