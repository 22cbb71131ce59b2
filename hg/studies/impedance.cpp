#include "hg/studies/impedance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <span>

#include "hg/studies/changes.h"
#include "hg/studies/motion_analysis.h"
#include "hg/studies/player.h"

namespace hg::studies {
namespace {

constexpr double kPi = std::numbers::pi;

// Part of the script, in s after the grasp.
struct Spell {
  double begin = 0.0, end = 0.0;
};

struct Plan {
  person::Script script;
  std::vector<Spell> sweeps;  // one per frequency, a whole number of periods
  Spell hold;                 // of the static force, with its ramp; empty without
};

// Half a period per ramp: nearly a sine. One period more than counts, for the transient.
Plan plan(const ImpedanceConfig& config, int axis, bool is_rigid) {
  Plan plan;
  plan.script.start[person::kGripChannel] = 1.0;
  const int channel = person::kWrenchChannel + axis;
  double time = config.pause;
  const auto ramp = [&](double duration, double value) {
    plan.script.segments.push_back(
        {.start_s = time, .duration_s = duration, .channel = channel, .value = value});
    time += duration;
  };
  for (const double frequency : config.frequency_Hz) {
    const double period = 1.0 / frequency;
    const int periods =
        std::max(config.periods, static_cast<int>(std::ceil(config.least * frequency)));
    const int before = std::max(1, static_cast<int>(std::ceil(0.3 * frequency)));
    for (int i = 0; i < before + periods; ++i) {
      if (i == before) plan.sweeps.push_back({time, time + periods * period});
      ramp(0.5 * period, config.force);
      ramp(0.5 * period, -config.force);
    }
    ramp(0.25, 0.0);
    time += 0.25;
  }
  if (is_rigid) {
    time += config.pause;
    plan.hold = {time, time + config.ramp + config.held};
    ramp(config.ramp, config.static_force);
    time = plan.hold.end;
    ramp(config.ramp, 0.0);
  }
  plan.script.duration_s = time + 0.1;
  return plan;
}

config::Scenario prepared(const config::Scenario& scenario, const ImpedanceConfig& config,
                          const ImpedanceCase& what, const Plan& plan) {
  config::Scenario pushed = scenario;
  pushed.twin.model.q_start.head<3>() = config.position;
  if (what.is_rigid) {
    set_free_twin(pushed, {.mass = config.heavy, .damping = config.heavy_damping});
  }
  config::Device& device = pushed.device;
  device.control.method = what.is_modal ? tracking::Method::kModal : tracking::Method::kMotorPd;
  if (!what.has_friction) take_friction(device.control);
  device.control.error_max = kInfinity;  // measures the deflection, not the loss of tracking
  // Nor the contradiction of a blind sensor and torques
  device.monitor.unexplained_tolerance = kInfinity;
  if (what.is_blind) {
    device.monitor.frozen_samples = 0.0;            // a zero reading is intended
    device.simulation.sensors.wrench.range = 1e-9;  // of full scale
    device.estimation.wrench.has_imu = false;       // would add a wrench of its own
  }
  play_script(pushed, plan.script);
  pushed.script.hand.tremor_rms = 0.0;
  return pushed;
}

std::complex<double> mobility_of(std::span<const HandleSample> motion, int axis, double frequency,
                                 double rate_Hz) {
  std::vector<double> v, f;
  for (const HandleSample& now : motion) {
    v.push_back(now.v[axis]);
    f.push_back(now.f[axis]);
  }
  return phasor(v, frequency, rate_Hz) / phasor(f, frequency, rate_Hz);
}

double compliance(const std::complex<double>& mobility, double frequency) {
  return std::abs(mobility) / (2.0 * kPi * frequency);
}

std::string heading(const ImpedanceReport& report, const std::string& what) {
  std::string text = fmt::format("{:<40}", what);
  for (const double frequency : report.config.frequency_Hz) {
    text += fmt::format("{:>7}", fmt::format("{:g} Hz", frequency));
  }
  return text;
}

std::string fault_text(const ImpedanceRun& run) {
  return run.fault == FaultCode::kNone ? "" : fmt::format("  fault: {}", to_string(run.fault));
}

}  // namespace

ImpedanceRun push(const config::Scenario& scenario, const ImpedanceConfig& config,
                  const ImpedanceCase& what, int axis) {
  const Plan plan = studies::plan(config, axis, what.is_rigid);
  const config::Scenario pushed = prepared(scenario, config, what, plan);
  const double rate_Hz = pushed.device.rate_Hz;
  Player player(pushed);
  std::vector<HandleSample> motion;  // from the grasp on, along the axes of H at the start
  Eigen::Matrix3d to_H;
  for (bool goes_on = true; goes_on; goes_on = player.end()) {
    player.begin();
    player.run();
    if (player.record().time_s < pushed.script.script.grasp_s) continue;
    const Truth& truth = player.truth();
    if (motion.empty()) to_H = truth.T_B_H.R.transpose();
    motion.push_back({to_H * truth.T_B_H.p, to_H * truth.twist.head<3>(),
                      to_H * truth.acceleration.head<3>(), to_H * truth.w_H.head<3>()});
  }
  ImpedanceRun run = {.name = what.name,
                      .is_rigid = what.is_rigid,
                      .axis = "xyz"[axis],
                      .fault = player.record().fault.code};
  if (run.fault != FaultCode::kNone) return run;  // parts of a period mean nothing
  const auto spell = [&](const Spell& part) {
    const auto at = [&](double time) {
      const auto index = static_cast<std::size_t>(std::llround(time * rate_Hz));
      return std::min(index, motion.size());
    };
    return std::span(motion).subspan(at(part.begin), at(part.end) - at(part.begin));
  };
  for (std::size_t i = 0; i < plan.sweeps.size(); ++i) {
    run.mobility.push_back(
        mobility_of(spell(plan.sweeps[i]), axis, config.frequency_Hz[i], rate_Hz));
  }
  const auto hold = spell(plan.hold);
  for (const HandleSample& now : hold) {
    run.static_end = (now.p - hold.front().p).norm();
    run.static_peak = std::max(run.static_peak, run.static_end);
  }
  return run;
}

ImpedanceReport measure_impedance(const config::Scenario& scenario, const ImpedanceConfig& config,
                                  const Progress& progress) {
  const std::array<ImpedanceCase, 8> cases = {
      {{.name = "modal"},
       {.name = "modal, no friction", .has_friction = false},
       {.name = "modal, blind", .is_blind = true},
       {.name = "modal, blind, no friction", .has_friction = false, .is_blind = true},
       {.name = "motor PD", .is_modal = false},
       {.name = "motor PD, blind, no friction",
        .is_modal = false,
        .has_friction = false,
        .is_blind = true},
       {.name = "modal", .is_rigid = false},
       {.name = "motor PD", .is_modal = false, .is_rigid = false}}};
  const FreeTwin twin = free_twin_of(scenario);
  ImpedanceReport report = {.config = config,
                            .mass = twin.mass,
                            .damping = twin.damping,
                            .runs = std::vector<ImpedanceRun>(3 * cases.size())};
  do_all(
      report.runs.size(),
      [&](std::size_t i) {
        report.runs[i] = push(scenario, config, cases[i / 3], static_cast<int>(i % 3));
      },
      progress);
  return report;
}

std::string to_text(const ImpedanceReport& report) {
  const ImpedanceConfig& config = report.config;
  std::string text = heading(report, "twin does not move: um per N") +
                     fmt::format("   {:g} N: peak, after {:g} s\n", config.static_force,
                                 config.ramp + config.held);
  for (const ImpedanceRun& run : report.runs) {
    if (!run.is_rigid) continue;
    text += fmt::format("{:<40}", fmt::format("{}, along {}", run.name, run.axis));
    for (std::size_t i = 0; i < run.mobility.size(); ++i) {
      text += fmt::format("{:>7.1f}", 1e6 * compliance(run.mobility[i], config.frequency_Hz[i]));
    }
    if (run.fault == FaultCode::kNone) {
      text += fmt::format("{:>10.2f} {:>8.2f} mm", 1e3 * run.static_peak, 1e3 * run.static_end);
    }
    text += fault_text(run) + "\n";
  }
  text +=
      "blind: the force/torque sensor shows nothing, so nothing is fed forward\n"
      "control notes 1: modal 22 without a peak, 3 with wrench feedforward; motor PD 29, peak "
      "49 at 3 Hz,\n13 to 25 with it; 50 N without it: modal 2.5 mm, motor PD 4.3 mm\n\n";
  text += heading(report, fmt::format("twin of {:g} kg, {:g} Ns/m: felt / rendered", report.mass,
                                      report.damping)) +
          "\n";
  for (const ImpedanceRun& run : report.runs) {
    if (run.is_rigid) continue;
    text += fmt::format("{:<40}", fmt::format("{}, along {}", run.name, run.axis));
    for (std::size_t i = 0; i < run.mobility.size(); ++i) {
      const std::complex<double> wanted = {report.damping,
                                           2.0 * kPi * config.frequency_Hz[i] * report.mass};
      text += fmt::format("{:>7.2f}", std::abs(1.0 / (run.mobility[i] * wanted)));
    }
    text += fault_text(run) + "\n";
  }
  return text;
}

nlohmann::ordered_json to_json(const ImpedanceReport& report) {
  nlohmann::ordered_json json;
  json["experiment"] = "impedance";
  json["frequency_Hz"] = report.config.frequency_Hz;
  json["twin"] = {{"mass_kg", report.mass}, {"damping_Ns_per_m", report.damping}};
  json["runs"] = nlohmann::ordered_json::array();
  for (const ImpedanceRun& run : report.runs) {
    nlohmann::ordered_json entry;
    entry["name"] = run.name;
    entry["is_rigid"] = run.is_rigid;
    entry["axis"] = std::string(1, run.axis);
    entry["mobility_m_per_Ns"] = nlohmann::ordered_json::array();
    for (const std::complex<double>& value : run.mobility) {
      entry["mobility_m_per_Ns"].push_back({value.real(), value.imag()});
    }
    if (run.is_rigid && run.fault == FaultCode::kNone) {
      entry["static_peak_m"] = run.static_peak;
      entry["static_end_m"] = run.static_end;
    }
    if (run.fault != FaultCode::kNone) entry["fault"] = to_string(run.fault);
    json["runs"].push_back(entry);
  }
  return json;
}

}  // namespace hg::studies
