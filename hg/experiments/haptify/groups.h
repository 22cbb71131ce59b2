/// The groups of measurements of benchmark.h.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/free_twin.h"
#include "hg/experiments/haptify/benchmark.h"
#include "hg/experiments/haptify/free_space.h"
#include "hg/experiments/haptify/surface.h"
#include "hg/experiments/place.h"
#include "hg/simulator/person/hand.h"

namespace hg::haptify {

/// A lighter body than the shipped one, for comparison; [C] 4.
inline constexpr experiments::FreeTwin kLightBody = {.mass = 3.0, .damping = 2.0};

/// One run of a measurement, not yet played.
struct Play {
  nlohmann::json condition;                 ///< differs from run to run: seed, axis, body
  std::function<nlohmann::json()> measure;  ///< plays it and returns the result
};

struct Group {
  const config::Scenario& scenario;
  const HaptifyOptions& options;
  experiments::Runs& runs;
  Benchmark& out;
  const experiments::Place& place;  ///< where the handle is held and moved

  /// Seeds of the repetitions.
  std::vector<std::uint64_t> seeds() const;
  /// Plays the runs of the measurement `name` and adds them to `out`; `together`: see Runs::next().
  void add(const std::string& name, const nlohmann::json& settings, const std::vector<Play>& plays,
           std::size_t together = 1) const;
};

/// Names and presets of the hands that are compared; of a quick run the normal one.
std::vector<std::pair<std::string, person::HandPreset>> hands(bool is_quick);

/// The scenario with another free body.
config::Scenario with_body(config::Scenario scenario, const experiments::FreeTwin& body);

nlohmann::json as_json(const experiments::FreeTwin& body);

/// The configuration of a measurement that has a position, with the middle of the place.
template <class Config>
Config placed(Config config, const experiments::Place& place) {
  config.position = place.middle;
  return config;
}

/// Strokes through the box of the place.
FreeSpaceConfig free_space_at(const experiments::Place& place);
/// Strokes on a surface and presses, about the middle of the place.
SurfaceConfig surface_at(const experiments::Place& place);

/// The result of a run that the device cannot do; `why` begins with experiments::kNotPossible.
inline nlohmann::json impossible(const std::string& why) { return {{"failure", why}}; }

void add_workspace(const Group& group);
void add_free_space(const Group& group);
void add_sources(const Group& group);
void add_dynamics(const Group& group);
void add_sliding(const Group& group);
void add_stiffness(const Group& group);
void add_peak(const Group& group);
void add_z_width(const Group& group);
void add_transparency(const Group& group);
void add_force_response(const Group& group);
void add_latency(const Group& group);
void add_impacts(const Group& group);
void add_felt_mass(const Group& group);
void add_rotation(const Group& group);
void add_springs(const Group& group);

}  // namespace hg::haptify
