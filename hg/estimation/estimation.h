/// From sensors to state: unwrapped joints, gantry motion, user wrench at the handle.
///
/// The gantry's velocity and acceleration come from an observer with the drive model and the
/// command as input, never from differences of a quantised encoder ([HANDBOOK] 1.5).
/// No allocation, noexcept after set-up.
#pragma once

#include <array>

#include "hg/core/types.h"
#include "hg/model/chain.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/state.h"

namespace hg::estimation {

/// Set-up data.
struct Config {
  double dt = 1e-3;               ///< period, s
  DriveModel drive;               ///< of every gantry axis
  double observer_pole_Hz = 8.0;  ///< triple pole of the gantry observer
  Pose T_H_S;                     ///< force/torque sensor S in the handle frame H
};

/// Observer of one gantry axis: q, dq and an acceleration disturbance; [C] 2.
struct GantryObserver {
  double q = 0.0, dq = 0.0, ddq = 0.0;
  double disturbance = 0.0;
  CommandDelay delay;
};

struct State {
  bool is_started = false;
  std::array<GantryObserver, kMaxGantry> gantry;
  VectorM q_m;  ///< unwrapped joints of the last sample
};

class Estimation {
 public:
  /// `chain` holds the gantry joints first; `handle` is its frame H.
  Estimation(const Config& config, const model::Chain& chain, int n_p, int n_m, int handle);

  /// `dq_p_cmd` is the gantry command that was sent in the last cycle (n_p).
  RobotState step(const SensorFrame& sensors, const VectorP& dq_p_cmd, State& state) noexcept;

 private:
  bool turns_without_end(int joint) const noexcept;

  Config config_;
  model::Chain chain_;
  int n_p_, n_m_, handle_;
  int dead_periods_;
};

}  // namespace hg::estimation
