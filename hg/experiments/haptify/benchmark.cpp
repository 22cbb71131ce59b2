#include "hg/experiments/haptify/benchmark.h"

#include "hg/core/error.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/groups.h"

namespace hg::haptify {

std::vector<std::uint64_t> Group::seeds() const {
  std::vector<std::uint64_t> all;
  for (int i = 0; i < options.repetitions; ++i) {
    all.push_back(options.seed + static_cast<std::uint64_t>(i));
  }
  return all;
}

void Group::add(const std::string& name, const nlohmann::json& settings,
                const std::vector<Play>& plays, std::size_t together) const {
  const auto play = [&](std::size_t i) {
    try {
      return plays[i].measure();
    } catch (const SetupError& error) {
      return impossible(std::string(experiments::kNotPossible) + error.what());
    }
  };
  std::vector<nlohmann::json> played = runs.next(plays.size(), play, together);
  for (std::size_t i = 0; i < plays.size(); ++i) played[i].update(plays[i].condition);
  for (const nlohmann::json& run : played) {
    const std::string failure = run.value("failure", "");
    const bool is_possible = !failure.starts_with(experiments::kNotPossible);
    out.has_failures = out.has_failures || (!failure.empty() && is_possible);
  }
  out.measurements[name] = {{"settings", settings}, {"runs", played}};
}

std::vector<std::pair<std::string, person::HandPreset>> hands(bool is_quick) {
  if (is_quick) return {{"normal", person::HandPreset::kNormal}};
  return {{"relaxed", person::HandPreset::kRelaxed},
          {"normal", person::HandPreset::kNormal},
          {"stiff", person::HandPreset::kStiff}};
}

config::Scenario with_body(config::Scenario scenario, const experiments::FreeTwin& body) {
  experiments::set_free_twin(scenario, body);
  return scenario;
}

nlohmann::json as_json(const experiments::FreeTwin& body) {
  return {{"mass", body.mass}, {"damping", body.damping}};
}

FreeSpaceConfig free_space_at(const experiments::Place& place) {
  FreeSpaceConfig config;
  config.lower = place.lower;
  config.upper = place.upper;
  config.turn_range = place.turn;
  return config;
}

SurfaceConfig surface_at(const experiments::Place& place) {
  SurfaceConfig config = placed(SurfaceConfig(), place);
  if (place.is_found) config.position.head<2>().array() -= 0.5 * config.stroke;
  return config;
}

Benchmark measure(const config::Scenario& scenario, const HaptifyOptions& options,
                  experiments::Runs& runs) {
  const experiments::Place place = experiments::place_of(scenario.device);
  const config::Scenario held = experiments::at_place(scenario, place);
  Benchmark result = {.device = scenario.device.name, .place = experiments::to_text(place)};
  const Group group = {held, options, runs, result, place};
  add_workspace(group);
  add_free_space(group);
  add_sources(group);
  add_sliding(group);
  add_stiffness(group);
  add_peak(group);
  add_dynamics(group);
  add_transparency(group);
  add_force_response(group);
  add_latency(group);
  add_z_width(group);
  add_impacts(group);
  add_felt_mass(group);
  add_rotation(group);
  add_springs(group);
  return result;
}

}  // namespace hg::haptify
