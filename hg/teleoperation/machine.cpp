#include "hg/teleoperation/machine.h"

#include <algorithm>
#include <string>

#include "hg/core/error.h"

namespace hg::teleoperation {
namespace {

constexpr int kSteps = 8;  // per period: walls of 50 kN/m and 0.5 kg stay stable

}  // namespace

SimulatedMachine::SimulatedMachine(const SimulatedMachineConfig& config, double dt)
    : config_(config), dt_(dt) {
  const Eigen::Index size = config.x_start.size();
  if (size < 1) throw SetupError("remote: a machine needs a start position");
  for (const Wall& wall : config.walls) {
    if (wall.normal.size() != size) {
      throw SetupError("remote: the normal of a wall needs " + std::to_string(size) + " numbers");
    }
  }
  state_ = {config.x_start, PortVector::Zero(size), PortVector::Zero(size)};
  x_target_ = config.x_start;
  v_target_ = PortVector::Zero(size);
}

// Whether a rule of its own stops the machine, whose target moves with speed `v`.
bool SimulatedMachine::must_stop(const PortVector& v) const noexcept {
  const StopRules& stops = config_.stops;
  const double a = (v - v_target_).lpNorm<Eigen::Infinity>() / dt_;
  if (a > stops.acceleration || state_.f.lpNorm<Eigen::Infinity>() > stops.force ||
      state_.v.lpNorm<Eigen::Infinity>() > stops.speed) {
    return true;
  }
  for (std::size_t i = 0; i < config_.ranges.size(); ++i) {
    const double x = state_.x[static_cast<Eigen::Index>(i)];
    const Interval& range = config_.ranges[i];
    if (x < range.lb - stops.beyond || x > range.ub + stops.beyond) return true;
  }
  return false;
}

PortVector SimulatedMachine::wall_force() const noexcept {
  PortVector force = PortVector::Zero(state_.x.size());
  for (const Wall& wall : config_.walls) {
    const double depth = wall.offset - wall.normal.dot(state_.x);
    if (depth <= 0.0) continue;
    const double push = wall.stiffness * depth - wall.damping * wall.normal.dot(state_.v);
    force += std::max(0.0, push) * wall.normal;
  }
  return force;
}

void SimulatedMachine::read(MachineState& state) noexcept { state = state_; }

void SimulatedMachine::write(const RemoteTarget& target) noexcept {
  const PortVector v_target = (target.x - x_target_) / dt_;
  state_.has_stopped = state_.has_stopped || must_stop(v_target);
  const PortVector zero = PortVector::Zero(state_.x.size());
  const RemoteTarget hold = {x_target_, zero, zero};
  follow(state_.has_stopped ? hold : target);
  v_target_ = state_.has_stopped ? zero : v_target;
}

void SimulatedMachine::follow(const RemoteTarget& target) noexcept {
  const MachineImpedance& own = config_.impedance;
  const double h = dt_ / kSteps;
  const PortVector step = (target.x - x_target_) / kSteps;  // it moves there during the period
  for (int k = 0; k < kSteps; ++k) {
    x_target_ += step;
    PortVector drive =
        own.stiffness * (x_target_ - state_.x) + own.damping * (target.v - state_.v) + target.f;
    drive = drive.cwiseMax(-config_.force_max).cwiseMin(config_.force_max);
    state_.f = wall_force();
    state_.v += h / own.mass * (drive + state_.f - config_.friction * state_.v);
    state_.x += h * state_.v;
  }
}

}  // namespace hg::teleoperation
