/// Stability limit of contact: a hand of a certain stiffness holds a free body of a certain mass,
/// gets a kick, and comes to rest or not. Source: [C] 3.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/safety/passivity/passivity.h"
#include "hg/experiments/decay.h"
#include "hg/experiments/place.h"
#include "hg/simulator/person/hand.h"

namespace hg::experiments {

class Runs;

/// An arm that is a mass on a spring, without muscle limits and tremor. Its rotations are those of
/// the normal hand.
struct SpringHand {
  double mass = 1.5;           ///< mass of the arm, kg; [C] 3
  double damping_ratio = 0.2;  ///< damping ratio of the arm on its spring; [C] 3
  double grip = 1e4;           ///< stiffness of the grip, N/m; [C] 3
  double grip_ratio = 0.2;     ///< damping ratio of the arm on the grip, [A]: as on its spring
};
person::HandImpedance spring_hand(const SpringHand& hand, double stiffness);

struct Kick {
  double force = 15.0;     ///< force along the diagonal of the axes of H, N; [C] 3, direction [A]
  double duration = 0.01;  ///< duration of the kick, s; [C] 3
  double settling = 1.0;   ///< time from the grasp to the kick, s
  double watched = 4.0;    ///< time observed after the kick, s; see CalmRule
};

/// Adds the kick to a script at time `at_s`.
void add_kick(const Kick& kick, double at_s, person::Script& script);

struct StabilityConfig {
  /// Stiffness of spring hands, N/m; [C] 3
  std::vector<double> stiffness{100, 300, 1000, 2000, 3000, 6000};
  std::vector<double> mass{0.5, 1, 1.5, 2, 3, 4, 6, 10, 20};  ///< mass of the twin, kg; [C] 3
  std::vector<double> damping{4, 20};                         ///< damping of the twin, Ns/m; [C] 3
  SpringHand hand;
  Kick kick;
  CalmRule calm;
  /// Passivity reaction, off: the map shows where contact becomes unstable without it.
  passivity::Reaction reaction = passivity::Reaction::kOff;
  double least_mass = 0.1;                    ///< lightest twin tried, kg
  double mass_tolerance = 0.05;               ///< relative tolerance of the smallest stable mass
  Eigen::Vector3d position = Place{}.middle;  ///< position of the handle, m in B
};

/// Result of one kick.
struct KickOutcome {
  DecayClass verdict = DecayClass::kStable;
  double last_speed = 0.0;  ///< largest speed of the handle in the last window, m/s
  bool was_lost = false;    ///< the reference was not followed in the last window, or a fault came
  FaultCode fault = FaultCode::kNone;
};

/// One hand with one damping of the twin.
struct StabilityRow {
  std::string hand;
  double damping = 0.0;
  std::vector<KickOutcome> outcomes;  ///< one per mass of the configuration
  /// Smallest stable mass, refined below the first stable one of the row, kg; infinity = none.
  /// Heavier ones may be unstable again.
  double stable_from = 0.0;
};

struct StabilityMap {
  StabilityConfig config;
  std::vector<StabilityRow> rows;  ///< rows by damping; spring hands, then relaxed, normal, stiff
  std::string device;              ///< name and control of the device
};

/// The scenario of a kick: `scenario` gives device and free twin; its hand is replaced.
config::Scenario kicked(const config::Scenario& scenario, const StabilityConfig& config,
                        const person::HandImpedance& hand, double mass, double damping);

/// Plays the scenario of a kick. If the handle does not come to rest, the kick is repeated without
/// friction, to find the cause.
KickOutcome kick(const config::Scenario& scenario, const StabilityConfig& config,
                 const person::HandImpedance& hand, double mass, double damping);

/// Number of rows of the map.
std::size_t rows_of(const StabilityConfig& config);

/// Computes the map, a row per run, at place_of() the device, see place.h. Throws SetupError when
/// the twin of the scenario is not a free body.
StabilityMap make_stability_map(const config::Scenario& scenario, const StabilityConfig& config,
                                Runs& runs);

/// Results for python/hapticgiant/report/series.py.
nlohmann::ordered_json to_json(const StabilityMap& map);

}  // namespace hg::experiments
