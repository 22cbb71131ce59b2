/// Impedance at the handle by frequency: compliance of the device with a rigid twin, and accuracy
/// of rendering a movable twin. Source: [C] 1.
///
/// A person pushes along one axis of H to and fro, with smooth ramps; amplitudes at the frequency
/// itself come from the true force and the true velocity of the handle.
#pragma once

#include <complex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/scenario.h"
#include "hg/signals/fault.h"
#include "hg/studies/workers.h"

namespace hg::studies {

struct ImpedanceConfig {
  std::vector<double> frequency_Hz{0.5, 1, 2, 3, 5, 8, 12, 20, 30};  ///< [C] 1 goes to 30
  double force = 10.0;         ///< amplitude, N, [A]: small, but beyond the friction of the joints
  double static_force = 50.0;  ///< static force, N; [C] 1
  double ramp = 0.05;          ///< ramp time of the static force, s, [A]: a step without shock
  double held = 1.5;           ///< hold time of the static force, s; [C] 1 looks at 0.5 to 1 s
  double pause = 1.0;          ///< pause before the first push, s
  int periods = 6;             ///< evaluated periods per frequency, at least `least` long
  double least = 1.0;          ///< shortest evaluated time per frequency, s
  double heavy = 1e4;          ///< mass of a rigid twin, kg
  double heavy_damping = 1e5;  ///< damping of a rigid twin, Ns/m
  Eigen::Vector3d position{0.0, 0.0, -0.775};  ///< middle of the box of the handle, m in B
};

/// Configuration of the device that answers the push.
struct ImpedanceCase {
  std::string name;
  bool is_modal = true;  ///< modal control, otherwise motor PD
  bool has_friction = true;
  bool is_blind = false;  ///< the force/torque sensor reads zero: no wrench feedforward
  bool is_rigid = true;   ///< rigid twin, otherwise the scenario's
};

struct ImpedanceRun {
  std::string name;
  bool is_rigid = true;
  char axis = 'x';  ///< axis of H
  /// Velocity over force at ImpedanceConfig::frequency_Hz, m/(Ns); empty after a fault; the fields
  /// below are then 0.
  std::vector<std::complex<double>> mobility;
  double static_peak = 0.0;  ///< largest deflection under the static force, m; rigid twin only
  double static_end = 0.0;   ///< deflection at the end of the static force, m
  FaultCode fault = FaultCode::kNone;
};

struct ImpedanceReport {
  ImpedanceConfig config;
  double mass = 0.0, damping = 0.0;  ///< mass and damping of the scenario's twin
  std::vector<ImpedanceRun> runs;
};

/// Plays one case along `axis` 0..2 of H.
ImpedanceRun push(const config::Scenario& scenario, const ImpedanceConfig& config,
                  const ImpedanceCase& what, int axis);

/// Plays all cases and axes, on all cores. Throws SetupError when the twin is not a free body.
ImpedanceReport measure_impedance(const config::Scenario& scenario, const ImpedanceConfig& config,
                                  const Progress& progress);

std::string to_text(const ImpedanceReport& report);
nlohmann::ordered_json to_json(const ImpedanceReport& report);

}  // namespace hg::studies
