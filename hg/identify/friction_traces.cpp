#include "hg/identify/friction_traces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/core/error.h"
#include "hg/identify/settling.h"

namespace hg::identify {
namespace {

constexpr std::size_t kRemembered = 256;  // commands; more than the longest latency

}  // namespace

FrictionTraces::FrictionTraces(const DeviceModel& device, double current_lag)
    : current_share_(current_lag > 0.0 ? -std::expm1(-device.dt() / current_lag) : 1.0),
      settling_(kSettling_s / device.dt()),
      joints_(device.actuators.size()),
      given_(kRemembered) {
  if (device.actuators.empty() || device.follows_positions) {
    throw SetupError(
        "friction: needs a device that takes torques, with 'actuators'; the drives of this one "
        "follow positions");
  }
  for (FrictionTrace& joint : joints_) joint.period_s = device.dt();
  current_ = working_ = VectorM::Zero(joints_.size());
}

const FrictionTraces::Given* FrictionTraces::at_work(const SensorFrame& sensors) const {
  if (sensors.answered_sequence == 0) return nullptr;
  const Given& given = given_[sensors.answered_sequence % kRemembered];
  return given.sequence == sensors.answered_sequence ? &given : nullptr;
}

void FrictionTraces::take(const SensorFrame& sensors, const VectorM& tau) {
  const auto n = static_cast<Eigen::Index>(joints_.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    FrictionTrace& joint = joints_[i];
    double theta = sensors.theta_m[i];
    if (is_cut_) {
      joint.cuts.push_back(joint.theta.size());
    } else {
      theta += 2.0 * std::numbers::pi *
               std::round((theta_[i] - theta) / (2.0 * std::numbers::pi));  // unlimited joints
    }
    joint.theta.push_back(theta);
    joint.tau_motor.push_back(tau[i]);
    joint.tau_J.push_back(sensors.tau_m[i]);
    theta_.resize(n);
    theta_[i] = theta;
  }
  is_cut_ = false;
  ++used_;
}

void FrictionTraces::add(const Sample& sample) {
  const SensorFrame& sensors = sample.sensors;
  const auto n = static_cast<Eigen::Index>(joints_.size());
  const bool follows = samples_ > 0 && sensors.sequence == last_ + 1;
  if (samples_ > 0 && !follows) ++gaps_;
  ++samples_;
  last_ = sensors.sequence;
  const Given* given = at_work(sensors);
  const bool is_usable = given != nullptr && given->is_on && sensors.theta_m.size() == n &&
                         sensors.tau_m.size() == n && sensors.theta_m.allFinite() &&
                         sensors.tau_m.allFinite();
  current_ += current_share_ * (working_ - current_);
  on_ = is_usable && follows ? on_ + 1 : 0;
  if (on_ > settling_) {
    take(sensors, current_);
  } else {
    is_cut_ = true;
  }
  working_ = is_usable ? given->tau : VectorM::Zero(n);
  const CommandFrame& command = sample.command;
  given_[command.sequence % kRemembered] = {
      .sequence = command.sequence,
      .is_on = command.enable && command.tau_m.size() == n && command.tau_m.allFinite(),
      .tau = command.tau_m};
}

}  // namespace hg::identify
