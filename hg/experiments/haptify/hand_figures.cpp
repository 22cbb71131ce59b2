#include "hg/experiments/haptify/hand_figures.h"

#include <nlohmann/json.hpp>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/free_space.h"
#include "hg/experiments/haptify/groups.h"
#include "hg/experiments/haptify/response.h"
#include "hg/experiments/haptify/surface.h"
#include "hg/experiments/stability_map.h"
#include "hg/simulator/person/hand.h"

namespace hg::haptify {
namespace {

constexpr double kDamping = 4.0;  // of the bodies, Ns/m

double transparency(const config::Scenario& scenario, const experiments::Place& place,
                    std::uint64_t seed) {
  ResponseConfig config = placed(ResponseConfig(), place);
  config.frequency_Hz = {3, 5, 8, 12, 20, 30};
  const Response response = measure_response(scenario, config, 0, seed);
  return response.failure.empty() ? transparency_Hz(response) : 0.0;
}

double after_kick(const config::Scenario& scenario, const experiments::Place& place,
                  person::HandPreset hand, double mass) {
  return kick(scenario, placed(experiments::StabilityConfig(), place), person::hand(hand), mass,
              kDamping)
      .last_speed;
}

experiments::DecayClass wall(config::Scenario scenario, const experiments::Place& place,
                             double mass) {
  constexpr double kStiffness = 20e3, kWallDamping = 20.0;  // N/m, Ns/m
  experiments::set_free_twin(scenario, {.mass = mass, .damping = kDamping});
  return knock(scenario, surface_at(place), kStiffness, kWallDamping).verdict;
}

}  // namespace

HandFigures measure_hand_figures(const config::Scenario& given) {
  const experiments::Place place = experiments::place_of(given.device);
  const config::Scenario scenario = experiments::at_place(given, place);
  const std::uint64_t seed = scenario.device.simulation.seed;
  const FreeSpace walk = measure_free_space(scenario, free_space_at(place), seed);
  const Latency latency = measure_latency(scenario, placed(ResponseConfig(), place), 0, seed);
  return {.transparency_Hz = transparency(scenario, place, seed),
          .latency_s = latency.failure.empty() ? latency.motion_s : 0.0,
          .extra_force = walk.extra,
          .vibration = walk.vibration_rms,
          .centroid_Hz = walk.centroid_Hz,
          .joint_error = walk.joint_error,
          .light_normal = after_kick(scenario, place, person::HandPreset::kNormal, 0.3),
          .light_stiff = after_kick(scenario, place, person::HandPreset::kStiff, 0.4),
          .wall = {wall(scenario, place, 6.0), wall(scenario, place, 3.0)}};
}

nlohmann::ordered_json to_json(const HandFigures& figures) {
  return {{"transparency_Hz", figures.transparency_Hz},
          {"latency_s", figures.latency_s},
          {"extra_N", figures.extra_force},
          {"vibration_m_per_s2", figures.vibration},
          {"centroid_Hz", figures.centroid_Hz},
          {"joint_error_rad", figures.joint_error},
          {"light_normal_m_per_s", figures.light_normal},
          {"light_stiff_m_per_s", figures.light_stiff},
          {"wall", {to_string(figures.wall[0]), to_string(figures.wall[1])}}};
}

}  // namespace hg::haptify
