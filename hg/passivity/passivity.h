/// Watches the energy at the handle and whether hand and device shake each other, and says how much
/// inertia and damping calm them.
///
/// Source: [HANDBOOK] 9.6 (tank), 9.7; the index of oscillation and its numbers are those of
/// [C] 7: of the user's force f, x1 = LP30(f), x2 = LP3(x1), x3 = LP3(x2), high^2 = mean |x1-x2|^2,
/// low^2 = mean |x3|^2 over 0.2 s; it oscillates while high > 1 N and high > (low + 0.5 N) / 2, and
/// is detected once it has for `trip_time` (counted down twice as fast), or at high > 15 N.
/// Differs from [C] 7: detected after 0.25 s instead of 0.4 s. It must have turned round, too,
/// since a hard start or stop is no oscillation: twice, and six times while a limit or a surface
/// pushes back, and just after. What a person's tremor may be, up to 5 N rms about 10 Hz, is taken
/// off `high`. Torques, forces above 30 Hz and bouncing: hg/safety/shaking.h.
///
/// When detected the twin gets a damper at its end effector (`damping`), and so much inertia that
/// it is felt with `least_mass` at least. A growing inertia M is passive as long as M' / 2 <= D
/// ([HANDBOOK] 9.6), so it grows no faster than that damper allows. Both go back over a second, two
/// seconds after the last oscillation.
///
/// Tank: what the dampers of the twin take goes in; what the handle gives beyond the rendered
/// motion, w . (v_rendered - v_measured), and what a growing inertia takes, goes out.
///
/// Pure function of its arguments and the state: deterministic, no allocation, noexcept.
#pragma once

#include <cstdint>

#include "hg/core/turns.h"
#include "hg/core/types.h"
#include "hg/signals/state.h"

namespace hg::passivity {

enum class Reaction : std::uint8_t {
  kOff,      ///< nothing is computed
  kObserve,  ///< reported only
  kAct,      ///< the twin is calmed
};

/// Set-up data.
struct Config {
  Reaction reaction = Reaction::kObserve;
  double dt = 1e-3;         ///< s
  double trip_time = 0.25;  ///< of oscillation until it is detected, s
  double damping = 25.0;    ///< of the damper when calmed, Ns/m; [C] 7
  double least_mass = 3.0;  ///< felt at the handle when calmed, kg; [C] 7
  double tank_start = 5.0;  ///< J; [HANDBOOK] 9.6
  double tank_max = 20.0;   ///< J
  double tank_least = 0.1;  ///< J; below it no inertia is added
};

/// What a cycle of the rendering was like.
struct Input {
  Eigen::Vector3d f = Eigen::Vector3d::Zero();  ///< of the user on the handle, N
  double power_measured = 0.0;  ///< wrench of the user times measured twist of the handle, W
  double power_rendered = 0.0;  ///< wrench of the user times twist of the twin's end effector, W
  double dissipation = 0.0;     ///< of dampers and friction of the twin, W, >= 0
  double mass = 1.0;            ///< of the twin as set up, felt at the handle where least, kg
  double speed = 0.0;           ///< of the twin's end effector, m/s
  bool is_pushed_back = false;  ///< a limit or a surface acts on the twin
};

/// What is added to the twin.
struct Calming {
  double damping = 0.0;  ///< at the end effector, in all directions, Ns/m
  double inertia = 1.0;  ///< factor of its inertia, >= 1
};

struct State {
  bool is_started = false;
  Eigen::Vector3d x1 = Eigen::Vector3d::Zero(), x2 = Eigen::Vector3d::Zero(),
                  x3 = Eigen::Vector3d::Zero();
  double high = 0.0, low = 0.0;  ///< mean squares, N^2
  /// Band-pass about 10 Hz: its last inputs and outputs, and the mean square of it, N^2.
  Eigen::Vector3d in1 = Eigen::Vector3d::Zero(), in2 = Eigen::Vector3d::Zero(),
                  tremor1 = Eigen::Vector3d::Zero(), tremor2 = Eigen::Vector3d::Zero();
  double tremor = 0.0;
  Turns turns;                      ///< of x1 - x2
  double oscillates_s = 0.0;        ///< the counter
  double since_pushed_s = 0.0;      ///< since something pushed back
  double hold_s = 0.0;              ///< until calming ends
  double restless_s = 0.0;          ///< how long it has oscillated although fully calmed
  double tank = 0.0, energy = 0.0;  ///< J
  Calming calming;
};

/// The report of this cycle; `state.calming` is what the twin gets in the next one.
PassivityReport step(const Config& config, const Input& input, State& state) noexcept;

/// kOscillation when calming has not helped within 3 s, kEnergy when the tank has run empty; only
/// with Reaction::kAct.
Fault check(const Config& config, const PassivityReport& report, const State& state) noexcept;

}  // namespace hg::passivity
