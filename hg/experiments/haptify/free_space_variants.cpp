#include "hg/experiments/haptify/free_space_variants.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hg/experiments/changes.h"
#include "hg/experiments/place.h"

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

}  // namespace

std::vector<FreeSpaceVariant> free_space_variants() {
  using config::Scenario;
  return {
      {.name = "as shipped", .change = {}},
      {.name = "twin 3 kg, 2 Ns/m",
       .change = [](Scenario& s) { experiments::set_free_twin(s, {.mass = 3.0, .damping = 2.0}); }},
      {.name = "twin 6 kg, 1 Ns/m",
       .change = [](Scenario& s) { experiments::set_free_twin(s, {.mass = 6.0, .damping = 1.0}); }},
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
       .change = [](Scenario& s) { experiments::take_friction(s.device.model); },
       .takes_away = true,
       .needs = Needs::kElasticJoints},
      {.name = "controller knows the plant",
       .change = [](Scenario& s) { s.device.simulation.factors = {}; },
       .takes_away = true},
      {.name = "no tremor of the person",
       .change = [](Scenario& s) { s.script.hand.tremor_rms = 0.0; },
       .takes_away = true},
      {.name = "motor PD instead of modal control",
       .change = [](Scenario& s) { s.device.control.method = tracking::Method::kMotorPd; },
       .needs = Needs::kElasticJoints},
      {.name = "no handle compensation (no IMU)",
       .change = [](Scenario& s) { s.device.estimation.wrench.has_imu = false; },
       .needs = Needs::kInertialUnit},
      {.name = "gantry drives twice as slow",
       .change = [](Scenario& s) { s.device.simulation.factors.gantry_lag = 2.0; },
       .needs = Needs::kGantry},
      {.name = "gantry vibrates, 0.24 m/s^2, 12 Hz",
       .change = {},
       .vibration = {.acceleration = 0.24},
       .needs = Needs::kGantry}};
}

std::string no_variant(const config::SimulatedDeviceConfig& device,
                       const FreeSpaceVariant& variant) {
  const auto without = [](const char* what) {
    return fmt::format("{}the device has {}", experiments::kNotPossible, what);
  };
  switch (variant.needs) {
    case Needs::kNothing:
      return "";
    case Needs::kElasticJoints:
      return device.control.method == tracking::Method::kDrives
                 ? without("drives that follow positions")
                 : "";
    case Needs::kGantry:
      return device.model.n_p == 0 ? without("no gantry") : "";
    case Needs::kInertialUnit:
      return device.estimation.wrench.has_imu ? "" : without("no inertial unit");
  }
  return "";
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

std::vector<FreeSpaceRun> measure_variants(const config::Scenario& given,
                                           const FreeSpaceConfig& how, std::uint64_t seed,
                                           const experiments::Progress& progress) {
  const experiments::Place place = experiments::place_of(given.device);
  const config::Scenario scenario = experiments::at_place(given, place);
  FreeSpaceConfig config = how;
  if (place.is_found) {
    config.lower = place.lower;
    config.upper = place.upper;
    config.turn_range = place.turn;
  }
  const std::vector<FreeSpaceVariant> variants = free_space_variants();
  std::vector<FreeSpaceRun> runs(variants.size());
  experiments::do_all(
      variants.size(),
      [&](std::size_t i) {
        runs[i] = {.name = variants[i].name, .takes_away = variants[i].takes_away};
        const std::string why = no_variant(scenario.device, variants[i]);
        if (why.empty()) {
          runs[i].measured = measure_variant(scenario, variants[i], config, seed);
        } else {
          runs[i].measured.failure = why;
        }
      },
      progress);
  return runs;
}

nlohmann::ordered_json to_json(const std::vector<FreeSpaceRun>& runs) {
  nlohmann::ordered_json json;
  json["experiment"] = "free-space";
  json["force_below_Hz"] = kForceBand;
  json["vibration_above_Hz"] = kVibrationBand;
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
