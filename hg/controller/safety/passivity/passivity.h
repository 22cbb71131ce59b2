/// Monitors the energy at the handle and oscillations between hand and device, and computes the
/// inertia and damping that end them.
///
/// Source: [HANDBOOK] 9.6 (tank), 9.7; the index of oscillation and its numbers are those of [C] 7:
/// of the user's force f, x1 = LP30(f), x2 = LP3(x1), x3 = LP3(x2), high^2 = mean |x1-x2|^2, low^2
/// = mean |x3|^2 over 0.2 s; it oscillates while high > 1 N and high > (low + 0.5 N) / 2, and is
/// detected once it has for `trip_time` (counted down twice as fast), or at high > 15 N. Differs
/// from [C] 7: detected after 0.25 s instead of 0.4 s. The force must also have reversed, since a
/// hard start or stop is no oscillation: twice, and six times while a limit or a surface pushes
/// back, and just after. Possible tremor of a person, up to 5 N rms about 10 Hz, is subtracted from
/// `high`. Torques, forces above 30 Hz and bouncing: hg/controller/safety/shaking.h.
///
/// On detection the twin gets a damper at its end effector (`damping`), and enough inertia to be
/// felt with `least_mass` at least. A growing inertia M is passive as long as M' / 2 <= D
/// ([HANDBOOK] 9.6), so it grows no faster than that damper allows. Both return over a second, two
/// seconds after the last oscillation.
///
/// Tank: charged by the dissipation of the twin; discharged by the energy that the handle gives
/// beyond the rendered motion, w . (v_rendered - v_measured), and by the energy that a growing
/// inertia takes.
///
/// Pure function of its arguments and the state: deterministic, no allocation, noexcept.
#pragma once

#include <cstdint>

#include "hg/controller/safety/passivity/passivity_config.h"
#include "hg/core/turns.h"
#include "hg/core/types.h"
#include "hg/signals/added_impedance.h"
#include "hg/signals/state.h"

namespace hg::passivity {

/// Inputs of one cycle of the rendering.
struct PassivityInput {
  Eigen::Vector3d f = Eigen::Vector3d::Zero();  ///< Force of the user on the handle, N
  double power_measured = 0.0;  ///< Wrench of the user times measured twist of the handle, W
  double power_rendered = 0.0;  ///< Wrench of the user times twist of the twin's end effector, W
  double dissipation = 0.0;     ///< Dissipation of dampers and friction of the twin, W, >= 0
  double mass = 1.0;            ///< Least mass of the twin as set up, felt at the handle, kg
  double speed = 0.0;           ///< Speed of the twin's end effector, m/s
  bool is_pushed_back = false;  ///< A limit or a surface acts on the twin
};

struct PassivityState {
  bool is_started = false;
  Eigen::Vector3d x1 = Eigen::Vector3d::Zero(), x2 = Eigen::Vector3d::Zero(),
                  x3 = Eigen::Vector3d::Zero();
  double high = 0.0, low = 0.0;  ///< Mean squares of high and low band, N^2
  /// Band-pass about 10 Hz: its last inputs and outputs, and its mean square `tremor`, N^2.
  Eigen::Vector3d in1 = Eigen::Vector3d::Zero(), in2 = Eigen::Vector3d::Zero(),
                  tremor1 = Eigen::Vector3d::Zero(), tremor2 = Eigen::Vector3d::Zero();
  double tremor = 0.0;
  Turns turns;                      ///< Reversals of x1 - x2
  double oscillates_s = 0.0;        ///< Detection counter, s
  double since_pushed_s = 0.0;      ///< Time since a limit or surface pushed back, s
  double hold_s = 0.0;              ///< Time until the added damping ends, s
  double restless_s = 0.0;          ///< Duration of oscillation at full damping, s
  double tank = 0.0, energy = 0.0;  ///< Energy of the tank, and energy given to the user, J
  AddedImpedance added;
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const PassivityState& state) {
  const auto& [is_started, x1, x2, x3, high, low, in1, in2, tremor1, tremor2, tremor, turns,
               oscillates_s, since_pushed_s, hold_s, restless_s, tank, energy, added] = state;
  hash.mix(is_started, x1, x2, x3, high, low, oscillates_s, since_pushed_s, hold_s, restless_s,
           tank, energy, added);
}

/// Advances by one cycle of `dt` (s) and returns its report; `state.added` applies to the twin in
/// the next one.
PassivityReport observe_energy(const PassivityConfig& config, double dt,
                               const PassivityInput& input, PassivityState& state) noexcept;

/// kOscillation when the oscillation has lasted 3 s at full damping, kEnergy when the tank has run
/// empty, else kNone; only with Reaction::kAct.
Fault passivity_fault(const PassivityConfig& config, const PassivityReport& report,
                      const PassivityState& state) noexcept;

}  // namespace hg::passivity
