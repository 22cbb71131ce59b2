/// The way of a device to where a run begins: a run of its own by the same law, with a free handle.
///
/// Its twin is the device's own mechanism, drawn by a spring at each joint from where the device
/// stands to the posture of the start. So all limits of the device hold on the way as in any run.
#pragma once

#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/core/types.h"
#include "hg/scenario/start_posture.h"
#include "hg/signals/state.h"

namespace hg::scenario {

/// The run that moves the device of `run`, which stands at `q_p` and `q_m`, to `start`: without
/// person, events, surfaces and faults.
config::Scenario way_to_start(const config::Scenario& run, const Start& start, const VectorP& q_p,
                              const VectorM& q_m);

/// Follows such a run: what its operator has to ask for, and when it is over.
class WayGuide {
 public:
  /// `way` as made by way_to_start() for `start`; must outlive the guide.
  WayGuide(const config::Scenario& way, const Start& start) : way_(way), start_(start) {}

  /// Takes every sample of the run, in order.
  void observe(const Sample& sample);

  /// Request that is due; kNone: none is. Requests act on their edge and are repeated from time to
  /// time. The device never runs by hand on its way.
  ModeRequest request();

  /// Whether the handle is at the start and the device at rest.
  bool is_there() const noexcept { return is_there_; }
  /// Whether the run has to end: it is there, or was stopped.
  bool is_over() const noexcept { return is_there_ || !cause_.empty(); }
  /// What a person has to do before the device moves; empty: nothing.
  std::string wanted() const;
  /// Distances of the handle from the start in the last sample, m and rad.
  double distance() const noexcept { return distance_; }
  double angle() const noexcept { return angle_; }
  /// Largest distance of a gantry axis from the posture of the start in the last sample, m or rad.
  double gantry_distance() const noexcept { return gantry_distance_; }
  /// Why the device is not there after the end of the run.
  std::string problem() const;

 private:
  void end(std::string cause);
  void look_for_stop(const Sample& sample);

  const config::Scenario& way_;
  Start start_;
  CycleRecord last_;
  SafetyInputs safety_;
  bool is_held_ = false, has_moved_ = false, is_there_ = false;
  double distance_ = kInfinity, angle_ = kInfinity, gantry_distance_ = kInfinity;
  double still_since_s_ = -1.0;     ///< at the start and at rest; negative: not so
  double asked_at_s_ = -kInfinity;  ///< time of the last request
  std::string cause_;               ///< why it has ended early
};

}  // namespace hg::scenario
