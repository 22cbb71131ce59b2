/// Target of the gantry: the position that brings the posture joints of the manipulator to their
/// goals at the same pose of the handle.
///
/// In closed form for the HapticGiant, [HG] (30); otherwise a few damped Gauss-Newton steps per
/// cycle on the model, warm started with the posture that the last cycle ended with. m or rad, as
/// the joints are. No allocation, noexcept after set-up.
#pragma once

#include <vector>

#include "hg/core/interval.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"
#include "hg/model/haptic_giant.h"
#include "hg/signals/state.h"

namespace hg::prepositioning {

using MatrixPM = MatrixUpTo<kMaxGantry + kMaxManipulator, kMaxGantry + kMaxManipulator>;

/// Part of the copyable state of a cycle.
struct TargetState {
  bool is_started = false;
  VectorPM q;  ///< Posture of the target
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const TargetState& state) {
  const auto& [is_started, q] = state;
  hash.mix(is_started, q);
}

class GantryTarget {
 public:
  /// Throws SetupError when the device has a closed form, but not its joints.
  explicit GantryTarget(const DeviceModel& device);

  /// Returns the target of the gantry; `robot` gives the gantry, `q_m` the manipulator reference.
  VectorP step(const RobotState& robot, const VectorM& q_m, TargetState& state) noexcept;

 private:
  double improve(const Pose& T_B_H, VectorPM& q) noexcept;
  VectorPM limited_step(MatrixPM H, VectorPM g, const VectorPM& q) const noexcept;

  bool has_closed_form_;
  model::haptic_giant::Lengths lengths_;  ///< Of a device with a closed form
  int n_p_, handle_;
  model::ChainData chain_;
  std::vector<Interval> range_;  ///< Ranges of gantry and manipulator joints
  VectorPM goal_;                ///< Goals of all joints; NaN = no goal
  std::vector<bool> is_free_;    ///< Joints that turn without end
  VectorPM at_rest_;
};

}  // namespace hg::prepositioning
