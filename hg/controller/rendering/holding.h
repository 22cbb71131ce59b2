/// How the weight that a motor holds changes with the posture.
///
/// Gravity has a potential: the change of one joint's torque with all joints is that of all torques
/// with this joint, one difference of gravity. SI units. No allocation after construction.
#pragma once

#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"

namespace hg::rendering {

class Holding {
 public:
  explicit Holding(const DeviceModel& device);

  /// Change of the torque of gravity on manipulator joint `joint` with all manipulator joints in
  /// posture `q` of all joints, n_m, Nm/rad; of slides N for Nm and m for rad. `now` has gravity in
  /// this posture.
  VectorM gradient(const VectorPM& q, const model::ChainData& now, int joint) noexcept;

 private:
  int n_p_, n_m_;
  model::ChainData chain_;
  VectorPM still_;
};

}  // namespace hg::rendering
