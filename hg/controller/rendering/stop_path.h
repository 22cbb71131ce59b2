/// Where the device comes to rest when all its joints brake from here in one proportion.
///
/// Ours; docs/concepts/law.md, "Stopping on its line". Joints at speeds dq that brake with -dq / T
/// come to rest at q + (r + T / 2) dq: the device stays on its line in joint space. T is the least
/// time, without corners, for which every joint brakes within a share of its rating and every motor
/// within its torque, against gravity and the present wrench of the user. Of a device without
/// gantry. SI units, frame B. No allocation after construction.
#pragma once

#include <span>
#include <vector>

#include "hg/controller/rendering/task_input.h"
#include "hg/core/interval.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"

namespace hg::rendering {

class StopPath {
 public:
  explicit StopPath(const DeviceModel& device);

  /// Finds the time to rest from the state of `reference`: `motors` has their torques, `known`
  /// their torques without those that accelerate the joints.
  void update(const DeviceModel& device, const model::ChainData& now,
              const ReferenceState& reference, std::span<const LimitRow> motors,
              const VectorM& known) noexcept;

  double time() const noexcept { return time_; }  ///< T, s
  /// The longest time that a motor needs alone, s.
  double motor_time() const noexcept { return motor_time_; }
  /// Time r + T / 2 in which a joint at its present speed covers its way to rest, s.
  double reach() const noexcept;

  /// Finds the posture at rest, for bound().
  void find_rest(const ReferenceState& reference) noexcept;
  /// Position of `frame` at rest, in B, m.
  const Eigen::Vector3d& place(int frame) const noexcept { return rest_.pose(frame).p; }
  /// Writes the change of the position of `frame` at rest along `axis` of B with the accelerations
  /// of the joints, divided by reach(), to `row` (n_m), and returns their allowed values for which
  /// it approaches the ends of `range` as exp(-t / 50 ms).
  Interval bound(int frame, int axis, const Interval& range, const ReferenceState& reference,
                 std::span<double> row) const noexcept;

 private:
  double reaction_;             ///< r, s
  VectorM deceleration_;        ///< Largest of each joint, rad/s^2 or m/s^2
  std::vector<Interval> ends_;  ///< Of each joint
  model::ChainData rest_;
  double time_ = 0.0, motor_time_ = 0.0;
  VectorM per_speed_;  ///< Change of T with the speed of each joint
};

}  // namespace hg::rendering
