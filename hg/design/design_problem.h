/// A design problem from its YAML file: variables with bounds, requirements, what counts; and what
/// a candidate is worth.
///
/// Source: [HG] III-B, [HANDBOOK] 8.5. capability = weighted mean of the coverages of the person's
/// poses, speeds and accelerations, of force and torque over what is required (at most 1), and of
/// the walkable area over what is required (at most 1). Broken requirements count as relative
/// violations, each at most 1. SI units.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/sources.h"
#include "hg/core/interval.h"
#include "hg/design/catalogue.h"
#include "hg/design/device_design.h"
#include "hg/design/device_metrics.h"
#include "hg/design/human_capability.h"

namespace hg::design {

/// The continuous variables, in this order; then sizes and ratios of joints m1 to m6.
inline constexpr std::array<const char*, 8> kContinuous = {
    "L1", "L2", "D3", "L4", "D6", "gantry_x", "gantry_y", "mount_height"};

/// What counts for the capability, in this order.
inline constexpr std::array<const char*, 8> kTerms = {
    "pose",  "velocity", "turn_velocity", "acceleration", "turn_acceleration",
    "force", "torque",   "walk"};

/// What the front is drawn against.
enum class Burden { kMovingMass, kPrice };

struct Requirements {
  double force = 50.0, torque = 10.0;  ///< In any direction, in 95 % of the poses; N, Nm
  double moving_mass = kInfinity;      ///< At the flange of the gantry, kg
  double price = kInfinity;
  double clearance = 0.0;    ///< Distance of the arm to the person's body, m
  double clear_share = 0.0;  ///< Share of the reached poses that must have it
  double walk_area = 0.0;    ///< Area of the hand's box, m^2
};

struct SearchOptions {
  int population = 40, generations = 60, islands = 4;
  int poses = 400;  ///< Poses of the hand that each candidate is judged with
  int seed = 1;
};

struct DesignProblem {
  std::string name;
  Catalogue catalogue;
  std::array<Interval, kContinuous.size()> bounds;  ///< m
  Requirements requirements;
  std::array<double, kTerms.size()> weights;
  Burden burden = Burden::kMovingMass;
  SearchOptions search;
  Sex sex = Sex::kMale;
  double stature_percentile = 50.0;
  StructurePrices prices;
  DesignBase base;
};

/// Reads a problem such as models/design/haptic_giant.yaml. Throws SetupError with all faults.
DesignProblem load_problem(const std::filesystem::path& file);

/// What a candidate is worth.
struct DesignScore {
  std::string fault;  ///< Why these variables make no device; all else is zero then
  std::array<double, kTerms.size()> terms{};  ///< 0 to 1
  double capability = 0.0;                    ///< Weighted mean of the terms, 0 to 1
  double moving_mass = 0.0;                   ///< kg
  double price = 0.0;
  double clear_share = 0.0;  ///< Share of the reached poses with the clearance
  double violation = 0.0;    ///< Sum of relative violations of the requirements; 0 = none
  DeviceMetrics metrics;
};

/// Judges candidates of a problem; const functions may be called from several threads.
class Judge {
 public:
  /// Draws the poses of the person. `problem` must outlive the judge.
  explicit Judge(const DesignProblem& problem, bool keeps_poses = false);

  DesignScore operator()(const DesignVariables& variables) const;
  const HumanCapability& human() const noexcept { return human_; }

 private:
  double clear_share(const DeviceDesign& design, const DeviceMetrics& metrics,
                     const Pose& T_B_F) const;

  const DesignProblem& problem_;
  bool keeps_poses_;
  HumanCapability human_;
};

/// Variables as a point of the search and back. Sizes are sorted on the way back, the largest
/// first: the requirement that they do not grow towards the hand; a ratio beyond those of its size
/// is the last one.
std::vector<double> to_point(const DesignVariables& variables);
DesignVariables to_variables(const DesignProblem& problem, const std::vector<double>& point);

/// Bounds of points, both included; the last 12 entries are whole numbers.
std::vector<double> lower_point(const DesignProblem& problem);
std::vector<double> upper_point(const DesignProblem& problem);

}  // namespace hg::design
