#include "hg/experiments/haptify/impedance.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/play.h"
#include "hg/experiments/place.h"

namespace hg::haptify {
namespace {

constexpr double kPause = 1.0;  // s, before a static force

config::Scenario prepared(const config::Scenario& scenario, const ImpedanceConfig& config,
                          const ImpedanceCase& what) {
  config::Scenario pushed = scenario;
  if (what.is_rigid) experiments::set_free_twin(pushed, config.rigid);
  config::SimulatedDeviceConfig& device = pushed.device;
  if (device.control.method != tracking::Method::kDrives) {
    device.control.method = what.is_modal ? tracking::Method::kModal : tracking::Method::kMotorPd;
  }
  if (!what.has_friction) experiments::take_friction(device.model);
  if (what.is_rigid) device.control.error_max = kInfinity;  // the deflection is what is measured
  if (what.is_blind) {
    // Nor the contradiction of a blind sensor and torques
    device.monitor.unexplained_tolerance = kInfinity;
    device.monitor.frozen_samples = 0.0;            // a zero reading is intended
    device.simulation.sensors.wrench.range = 1e-9;  // of full scale
    device.estimation.wrench.has_imu = false;       // would add a wrench of its own
  }
  return pushed;
}

Give measure_give(const config::Scenario& scenario, const ImpedanceConfig& config, int axis,
                  std::uint64_t seed) {
  person::Script script;
  const auto ramp = [&](double at_s, double force) {
    script.segments.push_back({.start_s = at_s,
                               .duration_s = config.ramp,
                               .channel = person::kWrenchChannel + axis,
                               .value = force});
  };
  const double end_s = kPause + config.ramp + config.held;
  ramp(kPause, config.static_force);
  ramp(end_s, 0.0);
  script.duration_s = end_s + config.ramp + 0.1;
  const Played played = play(instrument(scenario, config.response, script, seed));
  Give give = {.failure = played.failure};
  if (!played.failure.empty()) return give;
  const Instant* first = nullptr;
  for (const Instant& now : played.instants) {
    if (now.time_s < kPause || now.time_s > end_s) continue;
    if (first == nullptr) first = &now;
    give.end = (now.T_B_H.p - first->T_B_H.p).norm();
    give.peak = std::max(give.peak, give.end);
  }
  return give;
}

ResponseConfig response_of(const ImpedanceConfig& config, bool is_rigid) {
  ResponseConfig response = config.response;
  if (is_rigid) {
    std::erase_if(response.frequency_Hz,
                  [&](double frequency) { return frequency < config.rigid_from_Hz; });
  }
  return response;
}

}  // namespace

ImpedanceRun measure_case(const config::Scenario& scenario, const ImpedanceConfig& config,
                          const ImpedanceCase& what, int axis, std::uint64_t seed) {
  const config::Scenario pushed = prepared(scenario, config, what);
  ImpedanceRun run = {.name = what.name, .is_rigid = what.is_rigid, .axis = "xyz"[axis]};
  run.response = measure_response(pushed, response_of(config, what.is_rigid), axis, seed);
  if (what.is_rigid) run.give = measure_give(pushed, config, axis, seed);
  return run;
}

std::vector<ImpedanceCase> cases_of(const config::SimulatedDeviceConfig& device) {
  if (device.control.method == tracking::Method::kDrives) {
    return {{.name = "drives", .is_rigid = false},
            {.name = "drives"},
            {.name = "drives, blind", .is_blind = true}};
  }
  return {{.name = "modal", .is_rigid = false},
          {.name = "motor PD", .is_modal = false, .is_rigid = false},
          {.name = "modal"},
          {.name = "modal, no friction", .has_friction = false},
          {.name = "modal, blind", .is_blind = true},
          {.name = "modal, blind, no friction", .has_friction = false, .is_blind = true},
          {.name = "motor PD", .is_modal = false},
          {.name = "motor PD, blind, no friction",
           .is_modal = false,
           .has_friction = false,
           .is_blind = true}};
}

std::vector<ImpedanceRun> measure_impedance(const config::Scenario& given,
                                            const ImpedanceConfig& how, std::uint64_t seed,
                                            const experiments::Progress& progress) {
  const experiments::Place place = experiments::place_of(given.device);
  const config::Scenario scenario = experiments::at_place(given, place);
  experiments::free_twin_of(scenario);
  ImpedanceConfig config = how;
  if (place.is_found) config.response.position = place.middle;
  const std::vector<ImpedanceCase> cases = cases_of(scenario.device);
  std::vector<ImpedanceRun> runs(3 * cases.size());
  experiments::do_all(
      runs.size(),
      [&](std::size_t i) {
        runs[i] = measure_case(scenario, config, cases[i / 3], static_cast<int>(i % 3), seed);
      },
      progress);
  return runs;
}

nlohmann::ordered_json to_json(const std::vector<ImpedanceRun>& runs, const ImpedanceConfig& config,
                               const experiments::FreeTwin& twin) {
  nlohmann::ordered_json json;
  json["experiment"] = "impedance";
  json["twin"] = {{"mass_kg", twin.mass}, {"damping_Ns_per_m", twin.damping}};
  json["static_force_N"] = config.static_force;
  json["static_end_s"] = config.ramp + config.held;
  json["runs"] = nlohmann::ordered_json::array();
  for (const ImpedanceRun& run : runs) {
    nlohmann::ordered_json entry;
    entry["name"] = run.name;
    entry["is_rigid"] = run.is_rigid;
    entry["axis"] = std::string(1, run.axis);
    entry["frequency_Hz"] = entry["mobility_m_per_Ns"] = nlohmann::ordered_json::array();
    for (const Answer& answer : run.response.answers) {
      const std::complex<double> mobility = 1.0 / answer.impedance;
      entry["frequency_Hz"].push_back(answer.frequency_Hz);
      entry["mobility_m_per_Ns"].push_back({mobility.real(), mobility.imag()});
    }
    if (run.is_rigid && run.give.failure.empty()) {
      entry["static_peak_m"] = run.give.peak;
      entry["static_end_m"] = run.give.end;
    }
    if (!run.response.failure.empty()) entry["failure"] = run.response.failure;
    json["runs"].push_back(entry);
  }
  return json;
}

}  // namespace hg::haptify
