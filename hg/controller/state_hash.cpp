#include "hg/controller/state_hash.h"

#include <bit>
#include <cstring>
#include <type_traits>

namespace hg::controller {
namespace {

class Hash {
 public:
  std::uint64_t value() const noexcept { return value_; }

  void mix(std::uint64_t word) noexcept {
    value_ = (std::rotl(value_, 5) ^ word) * 0x517cc1b727220a95ULL;
  }
  void mix(double number) noexcept { mix(std::bit_cast<std::uint64_t>(number)); }
  template <typename Derived>
  void mix(const Eigen::PlainObjectBase<Derived>& v) noexcept {
    for (Eigen::Index i = 0; i < v.size(); ++i) mix(v.data()[i]);
  }
  void mix(const Interval& interval) noexcept {
    mix(interval.lb);
    mix(interval.ub);
  }
  // mixes the first `count` values, packed into words
  template <typename T>
  void mix_packed(const T* values, std::size_t count) noexcept {
    constexpr std::size_t kInWord = sizeof(std::uint64_t) / sizeof(T);
    static_assert(kInWord > 1 && std::has_unique_object_representations_v<T>);
    std::uint64_t word = 0;
    std::size_t i = 0;
    for (; i + kInWord <= count; i += kInWord) {
      std::memcpy(&word, values + i, sizeof(word));
      mix(word);
    }
    if (i == count) return;
    word = 0;
    std::memcpy(&word, values + i, (count - i) * sizeof(T));
    mix(word);
  }
  template <typename First, typename Second, typename... More>
  void mix(const First& first, const Second& second, const More&... more) noexcept {
    mix(first);
    mix(second);
    (mix(more), ...);
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

void mix(const rendering::TwinValues& values, std::size_t dofs, Hash& hash) noexcept {
  for (std::size_t i = 0; i < dofs; ++i) {
    const rendering::DofValues& dof = values.dofs[i];
    hash.mix(dof.stiffness, dof.rest, dof.preload, dof.damping, dof.quadratic_damping, dof.friction,
             dof.dq_max);
  }
  hash.mix(values.w_ref);
  hash.mix(values.loads.mass);
  hash.mix(values.loads.gravity);
}

void mix(const rendering::TwinInnerState& inner, std::size_t dofs, Hash& hash) noexcept {
  for (const rendering::LockState& lock : inner.locks) {
    hash.mix(std::uint64_t{lock.is_engaged} | std::uint64_t{lock.is_locked} << 1U);
    hash.mix(lock.edge);
  }
  hash.mix_packed(inner.sticks.data(), dofs);
  const rendering::TwinParameters& parameters = inner.parameters;
  mix(parameters.now, dofs, hash);
  mix(parameters.target, dofs, hash);
  for (std::size_t i = 0; i < dofs; ++i) {
    hash.mix(parameters.range[i]);
    hash.mix(parameters.moving[i].q);
    hash.mix(std::uint64_t{parameters.moving[i].is_crossed});
  }
  hash.mix_packed(parameters.holds.data(), parameters.holds.size());
  hash.mix_packed(parameters.may_be_overrun.data(), dofs);
}

void mix(const rendering::State& state, int rows, Hash& hash) noexcept {
  hash.mix(state.reference.q_m, state.reference.dq_m, state.reference.ddq_m);
  hash.mix(state.twin.q_a);
  hash.mix(state.twin.dq_a);
  hash.mix(state.twin.ddq_a);
  mix(state.inner, static_cast<std::size_t>(state.twin.dq_a.size()), hash);
  hash.mix_packed(state.active_set.state.data(), static_cast<std::size_t>(rows));
  hash.mix_packed(state.active_set.before.data(), static_cast<std::size_t>(rows));
  hash.mix_packed(state.touched.lower.data(), state.touched.lower.size());
  hash.mix_packed(state.touched.upper.data(), state.touched.upper.size());
  hash.mix(state.calming.damping);
  hash.mix(state.calming.inertia);
  hash.mix(state.contact.proxy);
  hash.mix(std::uint64_t{state.contact.is_started});
  hash.mix(state.contact.dent);
  hash.mix(state.contact.taken);
  hash.mix(state.motor_torque);
  hash.mix(state.ddq_p);
}

void mix(const estimation::TareState& tare, Hash& hash) noexcept {
  hash.mix(static_cast<std::uint64_t>(tare.status) | std::uint64_t{tare.is_valid} << 8U);
  hash.mix(static_cast<std::uint64_t>(tare.count));
  hash.mix(tare.offset);
  hash.mix(tare.mean);
  hash.mix(tare.square);
  hash.mix(tare.first_half);
  hash.mix(tare.q_m);
  hash.mix(tare.q_p);
}

void mix(const estimation::InertialUnitsState& state, Hash& hash) noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(state.trust.size()); ++i) {
    const estimation::UnitCalibration& unit = state.units[i];
    hash.mix(unit.slower);
    hash.mix(unit.gyroscope);
    hash.mix(unit.accelerometer);
    hash.mix(unit.moved_s, unit.variance, unit.misfit, unit.information.trace());
    hash.mix(static_cast<std::uint64_t>(state.same[i]));
  }
  const estimation::EncoderSample& newest = state.past[state.newest];
  hash.mix(newest.measured, newest.q, newest.dq, newest.ddq_expected);
  hash.mix(state.trust, state.found, state.carried, state.unseen, state.q, state.dq);
  hash.mix(state.variance, state.error);
  hash.mix(state.bend_rate, state.bend);
  hash.mix(state.share);
}

void mix(const estimation::State& state, Hash& hash) noexcept {
  for (const estimation::GantryObserver& axis : state.gantry) {
    hash.mix(axis.q, axis.dq, axis.ddq, axis.disturbance);
  }
  hash.mix(state.q_m);
  for (std::size_t i = 0; i < static_cast<std::size_t>(state.q_m.size()); ++i) {
    hash.mix(state.link[i].q, state.link[i].dq, state.motor[i].theta, state.motor[i].dtheta);
  }
  hash.mix(std::uint64_t{state.is_started} | std::uint64_t{state.wrench.is_started} << 1U);
  hash.mix(state.wrench.omega_S);
  hash.mix(state.wrench.alpha_S);
  hash.mix(state.wrench.w_S);
  mix(state.wrench.tare, hash);
  const estimation::InertialCheck& inertial = state.inertial;
  hash.mix(std::uint64_t{inertial.is_started} |
           static_cast<std::uint64_t>(inertial.rest_samples) << 1U |
           static_cast<std::uint64_t>(inertial.gravity_samples) << 32U);
  for (int axis = 0; axis < 3; ++axis) {
    hash.mix(Eigen::Vector3d(inertial.R_B_S.col(axis)));
  }
  hash.mix(inertial.bias, inertial.turn, inertial.turned, inertial.up_S, inertial.offset_S,
           inertial.p_S, inertial.v_S, inertial.slip);
  hash.mix(inertial.turned_in_all);
  hash.mix(inertial.offset_at_rest);
  if (state.units.is_started) mix(state.units, hash);
}

void mix(const collision::State& state, Hash& hash) noexcept {
  hash.mix(static_cast<std::uint64_t>(state.count));
  hash.mix(state.q);
  hash.mix(state.stop);
  for (std::size_t i = 0; i < static_cast<std::size_t>(state.count); ++i) {
    hash.mix(state.left[i]);
    hash.mix(state.allowed[i]);
  }
}

void mix(const safety::SupervisorState& state, Hash& hash) noexcept {
  hash.mix(static_cast<std::uint64_t>(state.state) |
           static_cast<std::uint64_t>(state.last_request) << 8U |
           static_cast<std::uint64_t>(state.stop) << 16U |
           static_cast<std::uint64_t>(state.fault.code) << 32U |
           static_cast<std::uint64_t>(state.also.code) << 48U);
  hash.mix(static_cast<std::uint64_t>(state.stop_samples));
  for (const Fault* fault : {&state.fault, &state.also}) {
    hash.mix(static_cast<std::uint64_t>(fault->index));
    hash.mix(fault->value);
    hash.mix(fault->limit);
  }
}

void mix(const safety::MonitorState& state, Hash& hash) noexcept {
  hash.mix_packed(state.broken.data(), state.broken.size());
  hash.mix_packed(state.same.data(), state.same.size());
  hash.mix(static_cast<std::uint64_t>(state.late_in_a_row) |
           std::uint64_t{state.has_sample} << 62U | std::uint64_t{state.is_broken} << 63U);
  hash.mix(state.time_s, state.clock_error, state.late);
  hash.mix(state.w_S);
  hash.mix(state.imu);
  hash.mix(state.q_m, state.tau_m, state.pulled_back, state.momentum, state.lowest, state.highest);
  hash.mix(state.q_p, state.dq_p_model, state.gantry_gap, state.gantry_drift, state.gantry_way,
           state.lowest_p, state.highest_p, state.stop_from_p, state.braking_ramp_p);
  hash.mix(std::uint64_t{state.is_stopping});
  hash.mix(state.stop_from);
  hash.mix(state.braking_ramp);
  hash.mix(state.ramp_speed);
}

void mix(const safety::BrakeState& state, Hash& hash) noexcept {
  hash.mix(std::uint64_t{state.samples_off} | std::uint64_t{state.was_powered} << 32U |
           static_cast<std::uint64_t>(state.slip.code) << 40U);
  hash.mix(std::uint64_t{state.broken});
  hash.mix(state.last);
  hash.mix(state.from);
  hash.mix(state.may_move);
}

void mix(const passivity::State& state, Hash& hash) noexcept {
  hash.mix(std::uint64_t{state.is_started});
  hash.mix(state.x1, state.x2, state.x3);
  hash.mix(state.high, state.low, state.oscillates_s, state.since_pushed_s, state.hold_s,
           state.restless_s, state.tank, state.energy, state.calming.damping,
           state.calming.inertia);
}

void mix(const compliance::State& state, Hash& hash) noexcept {
  hash.mix(std::uint64_t{state.is_started} | std::uint64_t{state.is_told} << 1U);
  hash.mix(state.dq, state.torque, state.variance, state.load);
  hash.mix(state.quiet_s);
  hash.mix(state.away);
}

}  // namespace

std::uint64_t hash_of(const State& state, int rows) noexcept {
  Hash hash;
  mix(state.rendering, rows, hash);
  hash.mix(std::uint64_t{state.gantry_target.is_started});
  hash.mix(state.gantry_target.q);
  hash.mix(state.dq_p);
  hash.mix(state.room.down);
  hash.mix(state.room.up);
  hash.mix(std::uint64_t{state.is_blocked} |
           std::uint64_t{state.motion == Motion::kBrakeJoints} << 1U |
           std::uint64_t{state.was_on} << 2U | std::uint64_t{state.is_coasting} << 3U |
           std::uint64_t{state.is_apart} << 4U | std::uint64_t{state.was_alone} << 5U);
  hash.mix(state.force_share);
  hash.mix(state.cycle);
  hash.mix(state.next_sequence);
  mix(state.supervisor, hash);
  mix(state.monitor, hash);
  mix(state.brakes, hash);
  hash.mix(state.q_m);
  hash.mix(state.tau_m);
  mix(state.collision, hash);
  mix(state.passivity, hash);
  mix(state.estimation, hash);
  const tracking::State& control = state.control;
  hash.mix(std::uint64_t{control.is_started} | std::uint64_t{control.is_saturated} << 1U);
  hash.mix(control.latency);
  hash.mix(static_cast<std::uint64_t>(control.answers) | static_cast<std::uint64_t>(control.late)
                                                             << 32U);
  hash.mix(control.poles.w0);
  hash.mix(control.modes.Q());
  hash.mix(control.integral, control.friction, control.tau_r, control.dtau_r, control.ddtau_r,
           control.unexplained, control.stiff);
  hash.mix(control.w_H);
  hash.mix(control.dw_H);
  if (control.feet.size() > 0) hash.mix(control.feet);  // some joint has presliding
  hash.mix(state.w_H);
  if (state.touch.dq.size() > 0) {  // contact detection is active
    mix(state.touch, hash);
    hash.mix(state.rendering.touch);
  }
  return hash.value();
}

}  // namespace hg::controller
