#include "hg/studies/haptify/hand_figures.h"

#include <fmt/format.h>

#include "hg/simulator/person/hand.h"
#include "hg/studies/changes.h"
#include "hg/studies/haptify/free_space.h"
#include "hg/studies/haptify/response.h"
#include "hg/studies/haptify/surface.h"
#include "hg/studies/stability_map.h"

namespace hg::haptify {
namespace {

constexpr double kDamping = 4.0;  // of the bodies, Ns/m

double transparency(const config::Scenario& scenario, std::uint64_t seed) {
  ResponseConfig config;
  config.frequency_Hz = {3, 5, 8, 12, 20, 30};
  const Response response = measure_response(scenario, config, 0, seed);
  return response.failure.empty() ? transparency_Hz(response) : 0.0;
}

double after_kick(const config::Scenario& scenario, person::HandPreset hand, double mass) {
  return kick(scenario, studies::StabilityConfig{}, person::hand(hand), mass, kDamping).last_speed;
}

studies::DecayClass wall(config::Scenario scenario, double mass) {
  constexpr double kStiffness = 20e3, kWallDamping = 20.0;  // N/m, Ns/m
  studies::set_free_twin(scenario, {.mass = mass, .damping = kDamping});
  return knock(scenario, SurfaceConfig{}, kStiffness, kWallDamping).verdict;
}

}  // namespace

HandFigures measure_hand_figures(const config::Scenario& scenario) {
  const std::uint64_t seed = scenario.device.simulation.seed;
  const FreeSpace walk = measure_free_space(scenario, FreeSpaceConfig{}, seed);
  const Latency latency = measure_latency(scenario, ResponseConfig{}, 0, seed);
  return {.transparency_Hz = transparency(scenario, seed),
          .latency_s = latency.failure.empty() ? latency.motion_s : 0.0,
          .extra_force = walk.extra,
          .vibration = walk.vibration_rms,
          .centroid_Hz = walk.centroid_Hz,
          .joint_error = walk.joint_error,
          .light_normal = after_kick(scenario, person::HandPreset::kNormal, 0.3),
          .light_stiff = after_kick(scenario, person::HandPreset::kStiff, 0.4),
          .wall = {wall(scenario, 6.0), wall(scenario, 3.0)}};
}

std::string to_text(const std::vector<std::pair<std::string, HandFigures>>& all) {
  std::string text =
      fmt::format("{:28} {:>12} {:>7} {:>7} {:>9} {:>8} {:>7} {:>8} {:>8}  {}\n",
                  "what a hand feels", "transparency", "latency", "extra", "vibration", "centroid",
                  "joints", "0.3 kg", "0.4 kg", "wall of 20 kN/m");
  text += fmt::format("{:28} {:>12} {:>7} {:>7} {:>9} {:>8} {:>7} {:>8} {:>8}  {}\n", "", "Hz",
                      "ms", "N", "m/s^2", "Hz", "mrad", "mm/s", "mm/s", "6 kg, 3 kg");
  for (const auto& [name, figures] : all) {
    text += fmt::format(
        "{:28} {:12.1f} {:7.1f} {:7.2f} {:9.3f} {:8.0f} {:7.2f} {:8.1f} {:8.1f}  {}, {}\n", name,
        figures.transparency_Hz, 1e3 * figures.latency_s, figures.extra_force, figures.vibration,
        figures.centroid_Hz, 1e3 * figures.joint_error, 1e3 * figures.light_normal,
        1e3 * figures.light_stiff, to_string(figures.wall[0]), to_string(figures.wall[1]));
  }
  return text;
}

}  // namespace hg::haptify
