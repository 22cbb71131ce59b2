/// A machine whose drives follow their reference perfectly; only its gantry has dead time and lag.
///
/// For devices that take positions, and for studying the control law in isolation. SI units.
/// Copyable; no allocation, noexcept after set-up.
#pragma once

#include <array>

#include "hg/core/stacked.h"
#include "hg/core/types.h"
#include "hg/model/chain_data.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/frames.h"
#include "hg/signals/truth.h"
#include "hg/simulator/plant/body_motion.h"

namespace hg::simulator {

/// Set-up data of an ideal plant.
struct IdealPlantConfig {
  double period = 1e-3;  ///< control period, s
  DriveModel drive;      ///< dynamics of every gantry axis
  VectorP q_p_start;
  VectorM q_m_start;
};

class IdealPlant {
 public:
  /// `chain` holds the gantry joints first; `handle` is its frame H.
  IdealPlant(const IdealPlantConfig& config, const model::ChainModel& chain, int handle);

  /// Advances by one period with drives that are on, or off and held by their brakes.
  void step(const CommandFrame& command, bool is_on) noexcept;
  const Truth& truth() const noexcept { return truth_; }
  /// Motion of a link of the chain.
  BodyMotion motion(int frame) const noexcept { return motion_of(chain_, frame, ddq_); }

 private:
  void observe(const VectorM& ddq_m) noexcept;

  IdealPlantConfig config_;
  model::ChainData chain_;
  int handle_, dead_periods_;
  std::array<CommandDelay, kMaxGantry> delays_;
  VectorPM ddq_;
  Truth truth_;
};

}  // namespace hg::simulator
