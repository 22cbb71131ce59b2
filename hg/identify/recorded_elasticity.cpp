#include "hg/identify/recorded_elasticity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/core/error.h"

namespace hg::identify {
namespace {

ActuatorModel nominal_of(const config::SimulatedDeviceConfig& device, int joint) {
  const auto i = static_cast<std::size_t>(joint);
  if (i < device.model.actuators.size()) return device.model.actuators[i];
  const std::vector<ActuatorModel>& simulated = device.simulation.drives.actuators;
  return i < simulated.size() ? simulated[i] : ActuatorModel{};
}

// From latency_s of a simulation to the delay that its drives have, s.
double extra_delay(const config::SimulatedDeviceConfig& device) {
  const double period = device.model.dt();
  return period - period / std::ceil(period / device.simulation.step_s - 1e-9);
}

void require_signals(const RecordedElasticity& result, const std::string& file) {
  if (result.has_both_sides || result.follows_positions) return;
  throw SetupError(
      fmt::format("{}{}: the device reports no motor encoders or no joint torques: stiffness needs "
                  "both, and the positions behind the gear",
                  recording::to_text(result.losses), file));
}

}  // namespace

RecordedElasticity identify_recorded_elasticity(
    const std::string& file, std::optional<config::SimulatedDeviceConfig> device) {
  const RecordedJoints recorded = read_joints(file, std::move(device));
  const DeviceModel& model = recorded.device.model;
  RecordedElasticity result;
  result.losses = recorded.losses;
  result.used_s = recorded.used_s;
  result.has_both_sides = std::ranges::all_of(recorded.parts, [](const JointMotion& part) {
    return part.theta.cols() == part.q.cols() && part.tau.cols() == part.q.cols();
  });
  result.follows_positions = model.follows_positions;
  result.nominal_latency = recorded.device.simulation.drives.latency;
  result.nominal_delay = result.nominal_latency + extra_delay(recorded.device);
  require_signals(result, file);

  const VectorM& ratios = recorded.device.simulation.gear_ratio;
  std::vector<DriveDelay> delays;
  for (int i = 0; i < model.n_m; ++i) {
    IdentifiedJoint joint;
    joint.name = model.manipulator_joint(i);
    joint.nominal = nominal_of(recorded.device, i);
    if (result.has_both_sides) {
      const double ratio = i < ratios.size() ? ratios[i] : 1.0;
      joint.elasticity = identify_elasticity(recorded.parts, i, model.dt(), joint.nominal, ratio);
    }
    if (result.follows_positions) {
      joint.delay = identify_delay(recorded.parts, i, model.dt());
      delays.push_back(joint.delay);
    }
    result.joints.push_back(std::move(joint));
  }
  result.delay = result.latency = common_delay(delays);
  result.latency.value = std::max(0.0, result.delay.value - extra_delay(recorded.device));
  return result;
}

}  // namespace hg::identify
