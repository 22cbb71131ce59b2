/// Impedance at the handle with parts of the control changed: how far the device gives way under a
/// twin that does not move, and how well it renders one that does. Source: [C] 1. The measure is
/// measure_response() of response.h.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/free_twin.h"
#include "hg/experiments/haptify/response.h"
#include "hg/experiments/workers.h"

namespace hg::haptify {

struct ImpedanceConfig {
  ResponseConfig response;  ///< pushes to and fro
  /// Lowest frequency at which a twin that does not move is pushed, Hz
  double rigid_from_Hz = 0.5;
  double static_force = 50.0;  ///< static force, N; [C] 1
  double ramp = 0.05;          ///< ramp time of the static force, s, [A]: a step without shock
  double held = 1.5;           ///< hold time of the static force, s; [C] 1 looks at 0.5 to 1 s
  experiments::FreeTwin rigid = {.mass = 1e4, .damping = 1e5};  ///< twin that does not move
};

/// Configuration of the device that answers the push.
struct ImpedanceCase {
  std::string name;
  bool is_modal = true;  ///< modal control, otherwise motor PD; drives that follow positions remain
  bool has_friction = true;
  bool is_blind = false;  ///< the force/torque sensor reads zero: no wrench feedforward
  bool is_rigid = true;   ///< rigid twin, otherwise the scenario's
};

/// Deflection under a static force, m.
struct Give {
  double peak = 0.0;  ///< largest deflection
  double end = 0.0;   ///< deflection at the end of the force
  std::string failure;
};

struct ImpedanceRun {
  std::string name;
  bool is_rigid = true;
  char axis = 'x';    ///< axis of H
  Response response;  ///< answers to the pushes
  Give give;          ///< rigid twin only
};

/// The cases of a device: of one whose drives follow positions without modes and friction.
std::vector<ImpedanceCase> cases_of(const config::SimulatedDeviceConfig& device);

/// Measures one case along `axis` 0..2 of H.
ImpedanceRun measure_case(const config::Scenario& scenario, const ImpedanceConfig& config,
                          const ImpedanceCase& what, int axis, std::uint64_t seed);

/// Measures all cases and axes, on all cores, at place_of() the device. Throws SetupError when the
/// twin is not a free body.
std::vector<ImpedanceRun> measure_impedance(const config::Scenario& scenario,
                                            const ImpedanceConfig& config, std::uint64_t seed,
                                            const experiments::Progress& progress);

nlohmann::ordered_json to_json(const std::vector<ImpedanceRun>& runs, const ImpedanceConfig& config,
                               const experiments::FreeTwin& twin);

}  // namespace hg::haptify
