#include "hg/studies/haptify/free_space_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hg/studies/changes.h"

namespace hg::haptify {
namespace {

void scale_noise(double factor, simulator::SensorsConfig& sensors) {
  sensors.torque.noise *= factor;
  sensors.wrench.force_noise *= factor;
  sensors.wrench.torque_noise *= factor;
  for (simulator::InertialSensorConfig* sensor : {&sensors.accelerometer, &sensors.gyroscope}) {
    sensor->noise *= factor;
    sensor->bias_instability *= factor;
    sensor->random_walk *= factor;
  }
}

void take_quantisation(simulator::SensorsConfig& sensors) {
  sensors.link_encoder.resolution = sensors.motor_encoder.resolution = 0.0;
  sensors.gantry_encoder.resolution = sensors.torque.resolution = sensors.wrench.resolution = 0.0;
  sensors.accelerometer.resolution = sensors.gyroscope.resolution = 0.0;
}

void take_gear_errors(simulator::SensorsConfig& sensors) {
  sensors.motor_encoder.error_1 = sensors.motor_encoder.error_2 = sensors.torque.ripple = 0.0;
}

// The imperfection whose removal improves the value most.
std::string dominant(const std::vector<FreeSpaceRun>& runs, double FreeSpace::*value,
                     const std::string& what, const std::string& unit) {
  const FreeSpaceRun* best = nullptr;
  const double shipped = runs.front().measured.*value;
  for (const FreeSpaceRun& run : runs) {
    if (!run.takes_away || !run.measured.failure.empty()) continue;
    if (best == nullptr || run.measured.*value < best->measured.*value) best = &run;
  }
  if (best == nullptr || best->measured.*value >= shipped) {
    return fmt::format("{:<20} nothing that was taken away makes it smaller\n", what);
  }
  return fmt::format("{:<20} most by '{}': {:.3f} instead of {:.3f} {}\n", what, best->name,
                     best->measured.*value, shipped, unit);
}

}  // namespace

std::vector<FreeSpaceVariant> free_space_variants() {
  using config::Scenario;
  return {{.name = "as shipped", .change = {}},
          {.name = "twin 3 kg, 2 Ns/m",
           .change = [](Scenario& s) { studies::set_free_twin(s, {.mass = 3.0, .damping = 2.0}); }},
          {.name = "twin 6 kg, 1 Ns/m",
           .change = [](Scenario& s) { studies::set_free_twin(s, {.mass = 6.0, .damping = 1.0}); }},
          {.name = "ideal sensors without delay",
           .change = [](Scenario& s) { s.device.simulation.sensors = simulator::ideal_sensors(); },
           .takes_away = true},
          {.name = "no sensor noise",
           .change = [](Scenario& s) { scale_noise(0.0, s.device.simulation.sensors); },
           .takes_away = true},
          {.name = "sensor noise x3",
           .change =
               [](Scenario& s) {
                 scale_noise(3.0, s.device.simulation.sensors);
                 estimation::TareConfig& tare = s.device.estimation.wrench.tare;
                 tare.noise_force *= 3.0;  // it refuses what noise does not explain
                 tare.noise_torque *= 3.0;
               }},
          {.name = "no quantisation",
           .change = [](Scenario& s) { take_quantisation(s.device.simulation.sensors); },
           .takes_away = true},
          {.name = "no gear error, no torque ripple",
           .change = [](Scenario& s) { take_gear_errors(s.device.simulation.sensors); },
           .takes_away = true},
          {.name = "no friction",
           .change = [](Scenario& s) { studies::take_friction(s.device.model); },
           .takes_away = true},
          {.name = "controller knows the plant",
           .change = [](Scenario& s) { s.device.simulation.factors = {}; },
           .takes_away = true},
          {.name = "no tremor of the person",
           .change = [](Scenario& s) { s.script.hand.tremor_rms = 0.0; },
           .takes_away = true},
          {.name = "motor PD instead of modal control",
           .change = [](Scenario& s) { s.device.control.method = tracking::Method::kMotorPd; }},
          {.name = "no handle compensation (no IMU)",
           .change = [](Scenario& s) { s.device.estimation.wrench.has_imu = false; }},
          {.name = "gantry drives twice as slow",
           .change = [](Scenario& s) { s.device.simulation.factors.gantry_lag = 2.0; }},
          {.name = "gantry vibrates, 0.24 m/s^2, 12 Hz",
           .change = {},
           .vibration = {.acceleration = 0.24}}};
}

void shake(const GantryVibration& vibration, double lag, double time_s, VectorP& dq_p) noexcept {
  const double omega = 2.0 * std::numbers::pi * vibration.frequency_Hz;
  const double speed = vibration.acceleration * std::hypot(1.0, omega * lag) / omega;
  for (Eigen::Index axis = 0; axis < dq_p.size(); ++axis) {
    dq_p[axis] +=
        speed * std::cos(omega * time_s - 0.5 * std::numbers::pi * static_cast<double>(axis));
  }
}

FreeSpace measure_variant(const config::Scenario& scenario, const FreeSpaceVariant& variant,
                          const FreeSpaceConfig& config, std::uint64_t seed) {
  config::Scenario changed = scenario;
  if (variant.change) variant.change(changed);
  Disturbance disturbance;
  if (variant.vibration.acceleration > 0.0) {
    const double lag =
        changed.device.model.drive.lag * changed.device.simulation.factors.gantry_lag;
    disturbance = [&variant, lag](double time_s, VectorP& dq_p) {
      shake(variant.vibration, lag, time_s, dq_p);
    };
  }
  return measure_free_space(changed, config, seed, disturbance);
}

std::vector<FreeSpaceRun> measure_variants(const config::Scenario& scenario,
                                           const FreeSpaceConfig& config, std::uint64_t seed,
                                           const studies::Progress& progress) {
  const std::vector<FreeSpaceVariant> variants = free_space_variants();
  std::vector<FreeSpaceRun> runs(variants.size());
  studies::do_all(
      variants.size(),
      [&](std::size_t i) {
        runs[i] = {.name = variants[i].name,
                   .takes_away = variants[i].takes_away,
                   .measured = measure_variant(scenario, variants[i], config, seed)};
      },
      progress);
  return runs;
}

std::string to_text(const std::vector<FreeSpaceRun>& runs) {
  std::string text = fmt::format(
      "{0:<36}{1:>7}{2:>7}{3:>7}{4:>11}{5:>8}{6:>9}{7:>8}{8:>8}\n"
      "{9:<36}{10:>7}{10:>7}{10:>7}{11:>11}{12:>8}{13:>9}{14:>8}{15:>8}\n",
      "", "force", "own", "extra", "vibration", "centre", "> 5 Hz", "joints", "torque", "variant",
      "N", "m/s^2", "Hz", "m/s^2", "mrad", "of peak");
  for (const FreeSpaceRun& run : runs) {
    const FreeSpace& it = run.measured;
    text += fmt::format(
        "{:<36}{:>7.2f}{:>7.2f}{:>7.2f}{:>11.3f}{:>8.0f}{:>9.3f}{:>8.2f}{:>8.2f}{}\n", run.name,
        it.force, it.own_share, it.extra, it.vibration_rms, it.centroid_Hz, it.acceleration_5Hz,
        1e3 * it.joint_error, it.torque_share, it.failure.empty() ? "" : "  failed: " + it.failure);
  }
  text += fmt::format(
      "\nown: mean |m a + b v| of the twin; extra: mean |f - (m a + b v)|; both of the true "
      "handle, below {:g} Hz\nvibration: rms above {:g} Hz, as in `hapticgiant haptify`\n\n",
      kForceBand, kVibrationBand);
  text += dominant(runs, &FreeSpace::extra, "extra force", "N");
  text += dominant(runs, &FreeSpace::vibration_rms, "vibration", "m/s^2");
  return text + dominant(runs, &FreeSpace::acceleration_5Hz, "above 5 Hz", "m/s^2");
}

nlohmann::ordered_json to_json(const std::vector<FreeSpaceRun>& runs) {
  nlohmann::ordered_json json;
  json["experiment"] = "free-space";
  json["variants"] = nlohmann::ordered_json::array();
  for (const FreeSpaceRun& run : runs) {
    const FreeSpace& it = run.measured;
    nlohmann::ordered_json entry;
    entry["name"] = run.name;
    entry["takes_away"] = run.takes_away;
    entry["measured"] = {
        {"force_N", it.force},           {"own_share_N", it.own_share},
        {"extra_N", it.extra},           {"vibration_m_per_s2", it.vibration_rms},
        {"centroid_Hz", it.centroid_Hz}, {"acceleration_above_5_Hz_m_per_s2", it.acceleration_5Hz}};
    entry["joint_error_rad"] = it.joint_error;
    entry["torque_share"] = it.torque_share;
    if (!it.failure.empty()) entry["failure"] = it.failure;
    json["variants"].push_back(entry);
  }
  return json;
}

}  // namespace hg::haptify
