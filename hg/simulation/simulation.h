/// The simulated world: a device that tracks its reference perfectly, a gantry with dead time and
/// lag, and a person who holds the handle.
///
/// One call of step() is one period. No allocation, noexcept after set-up.
#pragma once

#include <array>

#include "hg/core/types.h"
#include "hg/model/chain.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/frames.h"
#include "hg/user/person.h"

namespace hg::simulation {

/// Set-up data.
struct Config {
  double dt = 1e-3;  ///< period, s
  DriveModel drive;  ///< of every gantry axis
  Pose T_H_S;        ///< force/torque sensor S in the handle frame H
  bool has_dead_man = true;
  VectorM q_m_start;
  VectorP q_p_start;
};

class Simulation {
 public:
  /// `chain` holds the gantry joints first; `handle` is its frame H.
  Simulation(const Config& config, const model::Chain& chain, int handle, user::Person person);

  /// What the sensors say now.
  const SensorFrame& sensors() const noexcept { return sensors_; }
  /// Lives one period under `command`.
  void step(const CommandFrame& command) noexcept;

 private:
  struct Axis {
    double q = 0.0, dq = 0.0;
    CommandDelay delay;
  };
  void measure(const HandTarget& target) noexcept;
  double encoder(int joint, double q) const noexcept;

  Config config_;
  model::Chain chain_;
  int n_p_, n_m_, handle_;
  int dead_periods_;
  user::Person person_;
  double time_s_ = 0.0;
  VectorM q_m_, dq_m_;
  std::array<Axis, kMaxGantry> axes_;
  SensorFrame sensors_;
};

}  // namespace hg::simulation
