/// One pass of the control loop: sensors and operator in, command and record out.
///
/// No clock, no thread, no I/O: the same inputs give the same bits. No allocation after
/// construction.
#pragma once

#include <memory>

#include "hg/core/nonblocking.h"
#include "hg/core/stage_probe.h"
#include "hg/model/device_model.h"
#include "hg/signals/frames.h"
#include "hg/signals/state.h"

namespace hg::hqp {
class Problem;
class ProblemCapture;
}  // namespace hg::hqp
namespace hg::rendering {
struct TwinModel;
}

namespace hg::controller {

struct CycleConfig;
class CycleStages;
struct CycleState;

/// The control cycle. Its stages are behind a pointer, so that their headers are no part of this
/// one.
class Cycle {
 public:
  /// Builds all parts. Throws SetupError if they do not fit together.
  Cycle(const CycleConfig& config, const DeviceModel& device, const rendering::TwinModel& twin);
  Cycle(Cycle&& other) noexcept;
  Cycle& operator=(Cycle&& other) noexcept;
  ~Cycle();

  /// Runs one cycle: computes `command` and `record` from sensors and operator input.
  void step(const SensorFrame& sensors, const OperatorFrame& operator_input, CommandFrame& command,
            CycleRecord& record) noexcept HG_NONBLOCKING;

  /// Whether the handle is held, as far as the device can detect.
  bool is_held(const SensorFrame& sensors) const noexcept;
  /// The device for which this cycle was built.
  const DeviceModel& device() const noexcept;
  /// Time of the next step, s; that of its record. The clock of all that is planned for a run.
  double time_s() const noexcept;

  /// Installs a callback per stage; the default probe does nothing.
  void watch(const StageProbe& probe) noexcept;

  const CycleState& state() const noexcept;
  void restore(const CycleState& state) noexcept;
  /// Problem that the solver received in the last step.
  const hqp::Problem& problem() const noexcept;
  /// Problems of failed or slow solves, see Rendering::kept_problems(). May be read by one other
  /// thread.
  const hqp::ProblemCapture& kept_problems() const noexcept;
  /// Keeps the last solve of the last step, too, with the cycle's duration; no effect if the step
  /// had no solve because sensor values were not finite.
  void keep_problem(double cycle_time_us) noexcept;

 private:
  std::unique_ptr<CycleStages> stages_;
};

}  // namespace hg::controller
