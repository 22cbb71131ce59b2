/// From the samples of a recording to what each joint did: the motor's torque is that of the
/// command at work (answered_sequence) after the lag of the current.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hg/control/joint_control.h"
#include "hg/identification/friction.h"
#include "hg/signals/state.h"

namespace hg::identification {

class FrictionTraces {
 public:
  /// Throws SetupError for a device whose drives follow positions.
  explicit FrictionTraces(const control::Config& control);

  /// The next sample. Those with drives off, shortly after they came on, without motor encoders or
  /// without a known command at work are left out.
  void add(const Sample& sample);

  /// One per joint of the manipulator.
  const std::vector<FrictionTrace>& joints() const { return joints_; }
  std::uint64_t samples() const { return samples_; }  ///< that were added
  std::uint64_t used() const { return used_; }        ///< of them

 private:
  struct Given {
    std::uint64_t sequence = 0;
    bool is_on = false;
    VectorM tau;
  };
  const Given* at_work(const SensorFrame& sensors) const;
  void take(const SensorFrame& sensors, const VectorM& tau);

  double current_share_;  // of one period
  double settling_;       // samples
  std::vector<FrictionTrace> joints_;
  std::vector<Given> given_;  // a ring
  VectorM current_, theta_;   // of the motors, Nm; the last sample, unwrapped
  VectorM working_;           // command since the last sample
  std::uint64_t last_ = 0, samples_ = 0, used_ = 0;
  int on_ = 0;  // samples with drives on, one after the other
  bool is_cut_ = true;
};

}  // namespace hg::identification
