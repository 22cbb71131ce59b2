#include "hg/studies/free_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hg/studies/changes.h"
#include "hg/studies/player.h"

namespace hg::studies {
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

config::Scenario changed(config::Scenario scenario, const FreeSpaceVariant& variant) {
  if (variant.change) variant.change(scenario);
  return scenario;
}

std::string number(double value, int digits) {
  return std::isnan(value) ? "" : fmt::format("{:.{}f}", value, digits);
}

std::string row(const std::string& name, const FeelElsewhere& feel, const std::string& rest) {
  return fmt::format("{:<36}{:>7}{:>7}{:>7}{:>11}{:>8}{:>7}{}\n", name, number(feel.force, 2),
                     number(feel.own_share, 2), number(feel.extra, 2), number(feel.vibration_5, 3),
                     number(feel.vibration_20, 3), number(feel.centroid_Hz, 0), rest);
}

FeelElsewhere values_of(const Feel& feel) {
  return {feel.force,       feel.own_share,    feel.extra,
          feel.vibration_5, feel.vibration_20, feel.centroid_Hz};
}

bool is_known(const FeelElsewhere& feel) {
  return !std::isnan(feel.force) || !std::isnan(feel.extra) || !std::isnan(feel.vibration_5);
}

// The imperfection whose removal improves the value most.
std::string dominant(const std::vector<FreeSpaceRun>& runs, double Feel::*value,
                     const std::string& what, const std::string& unit) {
  const FreeSpaceRun* best = nullptr;
  const double shipped = runs.front().feel.*value;
  for (const FreeSpaceRun& run : runs) {
    if (!run.takes_away || run.judged_s == 0.0 || run.fault != FaultCode::kNone) continue;
    if (best == nullptr || run.feel.*value < best->feel.*value) best = &run;
  }
  if (best == nullptr || best->feel.*value >= shipped) {
    return fmt::format("{:<20} nothing that was taken away makes it smaller\n", what);
  }
  return fmt::format("{:<20} most by '{}': {:.3f} instead of {:.3f} {}\n", what, best->name,
                     best->feel.*value, shipped, unit);
}

nlohmann::ordered_json json_of(const FeelElsewhere& feel) {
  nlohmann::ordered_json json;
  const auto add = [&](const char* key, double value) {
    if (!std::isnan(value)) json[key] = value;
  };
  add("force_N", feel.force);
  add("own_share_N", feel.own_share);
  add("extra_N", feel.extra);
  add("vibration_above_5_Hz_m_per_s2", feel.vibration_5);
  add("vibration_above_20_Hz_m_per_s2", feel.vibration_20);
  add("centroid_Hz", feel.centroid_Hz);
  return json;
}

}  // namespace

std::vector<FreeSpaceVariant> free_space_variants() {
  using config::Scenario;
  return {{.name = "as shipped", .change = {}, .notes = {1.16, 1.17, 0.16, 0.060, 0.049, 97}},
          {.name = "twin 3 kg, 2 Ns/m",
           .change = [](Scenario& s) { set_free_twin(s, {.mass = 3.0, .damping = 2.0}); },
           .notes = {0.57, 0.58, 0.10, 0.066, 0.048, 93}},
          {.name = "twin 6 kg, 1 Ns/m",
           .change = [](Scenario& s) { set_free_twin(s, {.mass = 6.0, .damping = 1.0}); },
           .notes = {0.66, 0.68, 0.15, 0.060, 0.050, 96}},
          {.name = "ideal sensors without delay",
           .change = [](Scenario& s) { s.device.simulation.sensors = simulator::ideal_sensors(); },
           .takes_away = true},
          {.name = "no sensor noise",
           .change = [](Scenario& s) { scale_noise(0.0, s.device.simulation.sensors); },
           .notes = {.extra = 0.12, .vibration_5 = 0.033, .centroid_Hz = 77},
           .takes_away = true},
          {.name = "sensor noise x3",
           .change =
               [](Scenario& s) {
                 scale_noise(3.0, s.device.simulation.sensors);
                 estimation::TareConfig& tare = s.device.estimation.wrench.tare;
                 tare.noise_force *= 3.0;  // it refuses what noise does not explain
                 tare.noise_torque *= 3.0;
               },
           .notes = {.extra = 0.24, .vibration_5 = 0.133, .centroid_Hz = 101}},
          {.name = "no quantisation",
           .change = [](Scenario& s) { take_quantisation(s.device.simulation.sensors); },
           .takes_away = true},
          {.name = "no gear error, no torque ripple",
           .change = [](Scenario& s) { take_gear_errors(s.device.simulation.sensors); },
           .takes_away = true},
          {.name = "no friction",
           .change = [](Scenario& s) { take_friction(s.device.control); },
           .notes = {.extra = 0.05, .vibration_5 = 0.037, .vibration_20 = 0.035, .centroid_Hz = 97},
           .takes_away = true},
          {.name = "controller knows the plant",
           .change = [](Scenario& s) { s.device.simulation.factors = {}; },
           .takes_away = true},
          {.name = "no tremor of the person",
           .change = [](Scenario& s) { s.script.hand.tremor_rms = 0.0; },
           .takes_away = true},
          {.name = "motor PD instead of modal control",
           .change = [](Scenario& s) { s.device.control.method = tracking::Method::kMotorPd; },
           .notes = {.extra = 0.44, .vibration_5 = 0.092, .centroid_Hz = 99}},
          {.name = "no handle compensation (no IMU)",
           .change = [](Scenario& s) { s.device.estimation.wrench.has_imu = false; },
           .notes = {.force = 1.24, .extra = 0.18, .vibration_5 = 0.070, .centroid_Hz = 86}},
          {.name = "gantry drives twice as slow",
           .change = [](Scenario& s) { s.device.simulation.factors.gantry_lag = 2.0; }},
          {.name = "gantry vibrates, 0.24 m/s^2, 12 Hz",
           .change = {},
           .notes = {.extra = 2.6, .vibration_5 = 0.53, .vibration_20 = 0.07, .centroid_Hz = 83},
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

FreeSpaceRun walk(const config::Scenario& scenario, const FreeSpaceVariant& variant,
                  double settling) {
  const config::Scenario walked = changed(scenario, variant);
  const double rate_Hz = walked.device.rate_Hz;
  const double lag = walked.device.drive.lag * walked.device.simulation.factors.gantry_lag;
  Player player(walked);
  FreeSpaceRun run = {
      .name = variant.name, .notes = variant.notes, .takes_away = variant.takes_away};
  std::vector<HandleSample> motion;
  for (bool goes_on = true; goes_on; goes_on = player.end()) {
    player.begin();
    player.run();
    if (!player.is_running()) continue;
    const CycleRecord& record = player.record();
    const Truth& truth = player.truth();
    motion.push_back(
        {truth.T_B_H.p, truth.twist.head<3>(), truth.acceleration.head<3>(), truth.w_H.head<3>()});
    if (variant.vibration.acceleration > 0.0) {
      shake(variant.vibration, lag, record.time_s, player.command().dq_p);
    }
    if (static_cast<double>(motion.size()) <= settling * rate_Hz) continue;
    const double error = (record.reference.q_m - truth.q_m).cwiseAbs().maxCoeff();
    run.joint_error = std::max(run.joint_error, error);
    run.hand_distance = std::max(run.hand_distance, (record.T_B_E.p - truth.T_B_H.p).norm());
    const VectorM& share = record.tracking.torque_share;
    if (share.size() > 0) run.torque_share = std::max(run.torque_share, share.maxCoeff());
  }
  run.fault = player.record().fault.code;
  run.judged_s = std::max(0.0, static_cast<double>(motion.size()) / rate_Hz - settling);
  run.feel = feel(motion, free_twin_of(walked), rate_Hz, settling);
  return run;
}

std::vector<FreeSpaceRun> measure_free_space(const config::Scenario& scenario,
                                             const Progress& progress) {
  const std::vector<FreeSpaceVariant> variants = free_space_variants();
  std::vector<FreeSpaceRun> runs(variants.size());
  do_all(
      variants.size(), [&](std::size_t i) { runs[i] = walk(scenario, variants[i]); }, progress);
  return runs;
}

std::string to_text(const std::vector<FreeSpaceRun>& runs) {
  std::string text = fmt::format(
      "{0:<36}{1:>7}{2:>7}{3:>7}{4:>11}{5:>8}{6:>7}{7:>8}{8:>7}{9:>8}\n"
      "{10:<36}{11:>7}{11:>7}{11:>7}{12:>11}{13:>8}{14:>7}{15:>8}{16:>7}{17:>8}\n",
      "", "force", "own", "extra", "vibration", "m/s^2", "centre", "joints", "hand", "torque",
      "variant (beneath: control notes)", "N", ">5 Hz", ">20 Hz", "Hz", "mrad", "mm", "of peak");
  for (const FreeSpaceRun& run : runs) {
    std::string rest = fmt::format("{:>8.2f}{:>7.2f}{:>8.2f}", 1e3 * run.joint_error,
                                   1e3 * run.hand_distance, run.torque_share);
    if (run.judged_s == 0.0) rest += "  did not run";
    if (run.fault != FaultCode::kNone) rest += fmt::format("  fault: {}", to_string(run.fault));
    text += row(run.name, values_of(run.feel), rest);
    if (is_known(run.notes)) text += row("", run.notes, "");
  }
  text += row("the paper, Table III", kPaperFeel, "");
  text += fmt::format(
      "\nown: mean |m a + b v| of the twin; extra: mean |f - (m a + b v)|; both of the true "
      "handle, "
      "below {:g} Hz\n\n",
      kForceBand);
  text += dominant(runs, &Feel::extra, "extra force", "N");
  text += dominant(runs, &Feel::vibration_5, "vibration > 5 Hz", "m/s^2");
  return text + dominant(runs, &Feel::vibration_20, "vibration > 20 Hz", "m/s^2");
}

nlohmann::ordered_json to_json(const std::vector<FreeSpaceRun>& runs) {
  nlohmann::ordered_json json;
  json["experiment"] = "free-space";
  json["paper"] = json_of(kPaperFeel);
  json["variants"] = nlohmann::ordered_json::array();
  for (const FreeSpaceRun& run : runs) {
    nlohmann::ordered_json entry;
    entry["name"] = run.name;
    entry["takes_away"] = run.takes_away;
    entry["measured"] = json_of(values_of(run.feel));
    if (is_known(run.notes)) entry["control_notes"] = json_of(run.notes);
    entry["judged_s"] = run.judged_s;
    entry["joint_error_rad"] = run.joint_error;
    entry["hand_distance_m"] = run.hand_distance;
    entry["torque_share"] = run.torque_share;
    if (run.fault != FaultCode::kNone) entry["fault"] = to_string(run.fault);
    json["variants"].push_back(entry);
  }
  return json;
}

}  // namespace hg::studies
