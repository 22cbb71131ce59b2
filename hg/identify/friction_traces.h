/// Traces of each joint from the samples of a recording: the motor torque is that of the active
/// command (answered_sequence) after the current lag.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hg/identify/friction.h"
#include "hg/model/device_model.h"
#include "hg/signals/state.h"

namespace hg::identify {

class FrictionTraces {
 public:
  /// `current_lag`: time constant of the current, s. Throws SetupError for a device whose drives
  /// follow positions.
  FrictionTraces(const DeviceModel& device, double current_lag);

  /// Adds the next sample. Samples with drives off, shortly after they came on, without motor
  /// encoders or without a known active command are left out.
  void add(const Sample& sample);

  /// Trace per joint of the manipulator.
  const std::vector<FrictionTrace>& joints() const { return joints_; }
  std::uint64_t samples() const { return samples_; }  ///< number of added samples
  std::uint64_t used() const { return used_; }        ///< number of used samples
  std::uint64_t gaps() const { return gaps_; }        ///< places where samples are missing

 private:
  struct Given {
    std::uint64_t sequence = 0;
    bool is_on = false;
    VectorM tau;
  };
  const Given* at_work(const SensorFrame& sensors) const;
  void take(const SensorFrame& sensors, const VectorM& tau);

  double current_share_;  // share of the current reached in one period
  double settling_;       // settling time, samples
  std::vector<FrictionTrace> joints_;
  std::vector<Given> given_;  // ring buffer of commands
  VectorM current_, theta_;   // motor torques, Nm; motor positions of the last sample, unwrapped
  VectorM working_;           // active command since the last sample
  std::uint64_t last_ = 0, samples_ = 0, used_ = 0, gaps_ = 0;
  int on_ = 0;  // number of consecutive samples with drives on
  bool is_cut_ = true;
};

}  // namespace hg::identify
