/// Somebody stands in the way: a hand walks a free body past, and the arm hits a part of a body,
/// with and without giving way. Force and pressure beside the permissible ones of ISO/TS 15066.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/scenario.h"
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
  std::vector<double> speed{0.25, 0.5, 1.0};  ///< of the point when it hits, m/s
  int seeds = 4;                              ///< 1 .. seeds
  double watched = 1.5;                       ///< after the hit, s
  double settled = 0.5;   ///< after the hit, from which a contact is quasi-static, s; ISO/TS 15066
  double height = -0.75;  ///< of the handle, m in B
};

/// One hit.
struct ContactCase {
  std::string part;
  HittingPoint point;
  double speed = 0.0;
  bool is_clamped = false;  ///< the body stands against a wall
};

/// What became of it.
struct ContactRun {
  double hit_speed = 0.0;              ///< of the point when it hit, m/s; 0: it did not
  double force = 0.0;                  ///< largest, N
  double pressure = 0.0;               ///< largest, N/cm^2
  double settled_force = 0.0;          ///< largest from ContactConfig::settled on, N
  double impulse = 0.0;                ///< of the force, until then, Ns
  double contact = 0.0;                ///< how long the arm touched in all, s
  double compression = 0.0;            ///< largest, m
  double told = -1.0;                  ///< from the hit until it was told, s; < 0: it was not
  double stopped = -1.0;               ///< from the hit until the device began to stop, s; likewise
  FaultCode fault = FaultCode::kNone;  ///< that stopped it
};

/// All seeds of a case, the worst of each figure.
struct ContactResult {
  ContactCase what;
  ContactRun stiff;     ///< without compliance
  ContactRun yielding;  ///< with it
};

struct ContactMeasures {
  ContactConfig config;
  std::vector<ContactResult> results;
};

/// Plays one hit. `scenario` needs a free body as its twin, and a device with elastic joints.
ContactRun hit(const config::Scenario& scenario, const ContactConfig& config,
               const ContactCase& what, bool gives_way, std::uint64_t seed);

/// All cases, on all cores.
ContactMeasures measure_contact(const config::Scenario& scenario, const ContactConfig& config,
                                const Progress& progress);

std::string to_text(const ContactMeasures& report);
std::string to_markdown(const ContactMeasures& report);
nlohmann::ordered_json to_json(const ContactMeasures& report);

}  // namespace hg::experiments
