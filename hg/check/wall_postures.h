/// Postures of a device with its handle at given poses, as the law comes to them.
///
/// Deterministic. Set-up code: it allocates. SI units, frame B.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "hg/config/device.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/types.h"
#include "hg/model/chain_data.h"
#include "hg/workspace/survey.h"

namespace hg::check {

class WallPostures {
 public:
  /// `device` must outlive the object.
  explicit WallPostures(const config::DeviceConfig& device);

  /// Pose of the handle in the device's own posture: at the goals of `posture`, otherwise in the
  /// middle of the joints' ranges.
  const Pose& start() const noexcept { return start_; }
  /// The posture found last, after update() at rest.
  const model::ChainData& chain() const noexcept { return chain_; }

  /// Posture to which a hand leads the handle in a straight line from the device's own one, the
  /// gantry following; empty where none is permitted there.
  std::optional<Eigen::VectorXd> at(const Pose& T_B_H);

  /// Posture with the same pose of the handle, from `q` on along the motion of the manipulator in
  /// itself for as long as `worth` of chain() grows; the gantry stands. At most half a turn.
  Eigen::VectorXd best_from(Eigen::VectorXd q, const std::function<double()>& worth);

 private:
  bool is_permitted(const Eigen::VectorXd& q);
  std::optional<Eigen::VectorXd> closed_form(const Pose& T_B_H) const;
  std::optional<Eigen::VectorXd> led_to(const Pose& T_B_H);
  double approach(const Pose& wanted, Eigen::VectorXd goal, Eigen::VectorXd& q);
  /// Direction of joints, of length 1, that leaves the handle at rest in the posture of chain();
  /// zero without one.
  Eigen::VectorXd own_motion() const;

  const DeviceModel& device_;
  workspace::JointRanges ranges_;
  collision::Nearest shapes_;
  model::ChainData chain_;
  Eigen::VectorXd at_rest_, nominal_;
  Pose start_;
};

}  // namespace hg::check
