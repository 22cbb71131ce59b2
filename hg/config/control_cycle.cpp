#include "hg/config/control_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/config/torque_loop.h"
#include "hg/controller/cycle_config.h"
#include "hg/core/error.h"

namespace hg::config {
namespace {

constexpr int kStabilityPostures = 32;
constexpr int kFurtherLatency = 4;  // periods beyond what is expected

// Elastic joints: until which latency the gains that follow from it are stable.
tracking::ControlConfig checked_control(const DeviceConfig& device) {
  tracking::ControlConfig control = device.control;
  if (control.method == tracking::Method::kDrives) return control;
  const tracking::Loop loop = torque_loop(device);
  const double dt = device.model.dt();
  const int expected = std::max(1, static_cast<int>(std::ceil(control.loop.latency / dt - 1e-9)));
  const int periods =
      tracking::longest_stable_latency(loop, random_postures(device.model, kStabilityPostures, 1),
                                       expected + kFurtherLatency, expected);
  control.latency_max = (periods + 0.25) * dt;  // what was measured is a mean
  if (control.loop.latency > control.latency_max) {
    throw SetupError(fmt::format(
        "control.latency_s: at {:g} Hz the torque loop is stable up to {:g} s, got {:g}: raise the "
        "rate, lower rotor_pole_rad_per_s or spring_damping, or run with --plant ideal",
        device.model.rate_Hz, periods * dt, control.loop.latency));
  }
  return control;
}

}  // namespace

controller::Cycle make_cycle(const DeviceConfig& device, const Twin& twin,
                             std::vector<surfaces::Surface> surfaces,
                             std::vector<SolverCap> solver_caps) {
  return controller::Cycle({.estimation = device.estimation,
                            .prepositioning = device.prepositioning,
                            .rendering = device.rendering,
                            .control = checked_control(device),
                            .monitor = device.monitor,
                            .sanitiser = device.sanitiser,
                            .collision = device.collision,
                            .passivity = device.passivity,
                            .compliance = device.compliance,
                            .surfaces = std::move(surfaces),
                            .solver_caps = std::move(solver_caps)},
                           device.model, twin.model);
}

}  // namespace hg::config
