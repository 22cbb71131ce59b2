/// Set-up data of the monitor of energy and oscillation.
#pragma once

#include <cstdint>

namespace hg::passivity {

enum class Reaction : std::uint8_t {
  kOff,      ///< nothing is computed
  kObserve,  ///< reported only
  kAct,      ///< damping and inertia are added to the twin
};

/// Set-up data.
struct PassivityConfig {
  Reaction reaction = Reaction::kObserve;
  double trip_time = 0.25;  ///< Duration of oscillation until it is detected, s
  double damping = 25.0;    ///< Damping added on detection, Ns/m; [C] 7
  double least_mass = 3.0;  ///< Least mass felt at the handle on detection, kg; [C] 7
  double tank_start = 5.0;  ///< Initial energy of the tank, J; [HANDBOOK] 9.6
  double tank_max = 20.0;   ///< Largest energy of the tank, J
  double tank_least = 0.1;  ///< Energy of the tank below which no inertia is added, J
};

}  // namespace hg::passivity
