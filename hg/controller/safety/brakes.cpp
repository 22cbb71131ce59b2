#include "hg/controller/safety/brakes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hg::safety {
namespace {

// One of BrakedAxes.
struct Axis {
  int index = 0;  ///< Index used in faults
  bool is_slide = false;
  double speed_max = 0.0;
  double stop_distance = 0.0;
};

Axis axis_of(const MonitorConfig& config, const DeviceModel& device, int i) noexcept {
  if (i < device.n_p) {
    const bool is_slide = device.is_gantry_slide();
    return {device.n_m + i, is_slide, device.drive.dq_max,
            config.stop_distance_of_gantry(is_slide)};
  }
  const int joint = (i - device.n_p) % device.n_m;
  const bool is_slide = device.is_slide(joint);
  return {joint, is_slide, device.joint_limits[joint].dq_max,
          config.stop_distance_of_joint(is_slide)};
}

BrakedAxes positions_of(const SensorFrame& sensors) noexcept {
  const Eigen::Index n_p = sensors.q_p.size(), n_m = sensors.q_m.size();
  BrakedAxes q(n_p + n_m + sensors.theta_m.size());
  q.head(n_p) = sensors.q_p;
  q.segment(n_p, n_m) = sensors.q_m;
  q.tail(sensors.theta_m.size()) = sensors.theta_m;
  return q;
}

// distance between two encoder readings that may be wrapped, rad or m
double moved(const Axis& axis, double from, double to) noexcept {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return std::abs(axis.is_slide ? to - from : std::remainder(to - from, kTurn));
}

double slip_of(const MonitorConfig& config, const Axis& axis) noexcept {
  return axis.is_slide ? config.slide_brake_slip : config.brake_slip;
}

}  // namespace

Fault watch_brakes(const MonitorConfig& config, const DeviceModel& device,
                   const SensorFrame& sensors, bool is_powered, BrakeState& state) noexcept {
  const bool is_heard = sensors.driver_fault != FaultCode::kDeviceSilent &&
                        sensors.driver_fault != FaultCode::kDeviceGone;
  if (state.slip.code != FaultCode::kNone || !is_heard) return state.slip;
  const BrakedAxes q = positions_of(sensors);
  const bool has_last = state.last.size() == q.size();
  const BrakedAxes last = has_last ? state.last : q;
  state.last = q;
  if (is_powered) {
    state.was_powered = true;
    state.samples_off = 0;
    state.broken = 0;
  }
  if (is_powered || !state.was_powered) return {};

  const auto at_rest = static_cast<std::uint32_t>(config.stop_time / device.dt()) + 1;
  state.samples_off = std::min(state.samples_off + 1, at_rest + 1);
  const bool is_new = state.samples_off == 1 || state.from.size() != q.size();
  const bool is_over = state.samples_off == at_rest;
  if (is_new || is_over) {
    state.from = q;
    state.may_move.setZero(q.size());
  }
  Fault worst;
  double largest = 1.0;  // largest share of the allowed motion
  for (int i = 0; i < q.size(); ++i) {
    const Axis axis = axis_of(config, device, i);
    if (!std::isfinite(q[i])) continue;
    if (!std::isfinite(state.from[i])) state.from[i] = q[i];
    if (is_new || is_over) {
      const double speed =
          std::isfinite(last[i]) ? moved(axis, last[i], q[i]) / device.dt() : kInfinity;
      const double share = is_over ? 0.0 : std::min(1.0, speed / axis.speed_max);
      state.may_move[i] = slip_of(config, axis) + share * axis.stop_distance;
    }
    const double most = std::max(state.may_move[i], slip_of(config, axis));
    const double way = moved(axis, state.from[i], q[i]);
    if (way <= largest * most) continue;
    largest = way / most;
    worst = {FaultCode::kBrakesSlip, static_cast<std::int16_t>(axis.index), way, most};
  }
  state.broken = worst.code == FaultCode::kNone ? 0 : static_cast<std::uint16_t>(state.broken + 1);
  if (state.broken >= rule_of(FaultCode::kBrakesSlip).debounce.samples) state.slip = worst;
  return state.slip;
}

}  // namespace hg::safety
