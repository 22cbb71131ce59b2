/// Contact with a bystander: a hand walks a free body past, and the arm hits a body part, with and
/// without compliance. Force and pressure are compared with the permissible ones of ISO/TS 15066.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/workers.h"
#include "hg/signals/fault.h"

namespace hg::experiments {

/// A point of the arm that hits: the origin of a link.
struct HittingPoint {
  std::string name;
  std::string frame;
};

struct ContactConfig {
  std::vector<std::string> parts{"chest", "upper_arm", "hand", "face"};
  std::vector<HittingPoint> points{{"elbow", "elbow"}, {"wrist", "m5"}};
  std::vector<double> speed{0.25, 0.5, 1.0};  ///< speed of the point when it hits, m/s
  int seeds = 4;                              ///< number of seeds, 1 .. seeds
  double watched = 1.5;                       ///< time observed after the hit, s
  /// Time after the hit from which a contact is quasi-static, s; ISO/TS 15066
  double settled = 0.5;
  double height = -0.75;  ///< height of the handle, m in B
};

/// One hit.
struct ContactCase {
  std::string part;
  HittingPoint point;
  double speed = 0.0;
  bool is_clamped = false;  ///< the body stands against a wall
};

/// Result of one hit.
struct ContactRun {
  double hit_speed = 0.0;      ///< speed of the point when it hit, m/s; 0 = no hit
  double force = 0.0;          ///< largest force, N
  double pressure = 0.0;       ///< largest pressure, N/cm^2
  double settled_force = 0.0;  ///< largest force from ContactConfig::settled on, N
  double impulse = 0.0;        ///< impulse of the force until ContactConfig::settled, Ns
  double contact = 0.0;        ///< total contact time of the arm, s
  double compression = 0.0;    ///< largest compression, m
  double reported = -1.0;      ///< time from the hit until it was reported, s; < 0 = not reported
  double stopped = -1.0;  ///< time from the hit until the device began to stop, s; < 0 = it did not
  FaultCode fault = FaultCode::kNone;  ///< fault that stopped the device
};

/// All seeds of a case, the worst of each figure.
struct ContactResult {
  ContactCase what;
  ContactRun stiff;     ///< without compliance
  ContactRun yielding;  ///< with compliance
};

struct ContactMeasures {
  ContactConfig config;
  std::vector<ContactResult> results;
};

/// Plays one hit. `scenario` needs a free body as its twin, and a device with elastic joints.
ContactRun hit(const config::Scenario& scenario, const ContactConfig& config,
               const ContactCase& what, bool gives_way, std::uint64_t seed);

/// Plays all cases, on all cores.
ContactMeasures measure_contact(const config::Scenario& scenario, const ContactConfig& config,
                                const Progress& progress);

/// Results for python/hapticgiant/report/series.py, with the permissible values.
nlohmann::ordered_json to_json(const ContactMeasures& report);

}  // namespace hg::experiments
