#include "hg/config/control_cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/random.h"

namespace hg::config {
namespace {

constexpr int kStabilityPostures = 32;
constexpr int kMostDraws = 1'000'000;  // of a posture; takes less than a second
constexpr int kFurtherLatency = 4;     // periods beyond what is expected

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

std::vector<Eigen::VectorXd> random_postures(const DeviceModel& device, int count,
                                             std::uint32_t seed) {
  Random32 random(seed);
  std::vector<Eigen::VectorXd> postures;
  for (int k = 0; k < kMostDraws; ++k) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(device.n_p + device.n_m);
    for (int i = 0; i < device.n_m; ++i) {
      const limits::JointLimits& joint = device.joint_limits[i];
      const double lo = std::max(joint.q_min, -std::numbers::pi);
      const double hi = std::min(joint.q_max, std::numbers::pi);
      q[device.n_p + i] = lo + (hi - lo) * random.next();
    }
    const auto is_within = [&](const VirtualJoint& joint) {
      const double sum = joint.weights.dot(q.tail(device.n_m));
      return joint.limits.q_min <= sum && sum <= joint.limits.q_max;
    };
    if (!std::ranges::all_of(device.virtual_joints, is_within)) continue;
    postures.push_back(std::move(q));
    if (static_cast<int>(postures.size()) == count) return postures;
  }
  throw SetupError(fmt::format(
      "virtual_joints: only {} of {} random postures within the limits of the joints keep these "
      "limits, {} are needed to check that the torque loop is stable: widen them, or tighten those "
      "of the joints",
      postures.size(), kMostDraws, count));
}

tracking::Loop torque_loop(const DeviceConfig& device) {
  return {.config = device.control,
          .filters = {.link_pole_Hz = device.estimation.link_pole_Hz,
                      .motor_low_pass_Hz = device.estimation.motor_low_pass_Hz},
          .device = device.model};
}

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
