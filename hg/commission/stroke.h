/// One joint or axis of a machine, led a little way: what was measured, and what is wrong with it.
#pragma once

#include <string>
#include <vector>

#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"

namespace hg::commission {

/// Joints are counted with the gantry's axes first; rad, or m where they slide.
struct Stroke {
  int joint = -1;
  double way = 0.0;            ///< Commanded change, up to where the stroke ended
  VectorPM moved;              ///< Change of each encoder
  VectorPM lowest, highest;    ///< Its smallest and largest value under way
  VectorM motors;              ///< Change of each motor encoder; empty: there are none
  VectorM by_speed;            ///< Measured speed of each manipulator joint, integrated
  bool has_gyroscope = false;  ///< Whether `turned` was measured
  Eigen::Vector3d turned =
      Eigen::Vector3d::Zero();  ///< Angular velocity of S in S, integrated, rad
  bool is_cut = false;          ///< The drives were switched off on the way
  double torque = 0.0;          ///< Mean torque commanded to its motor in the middle of the way, Nm
  double late = 0.0;            ///< Time by which the encoder follows the command, s
};

/// What is wrong with a stroke, in words that name joints; empty: nothing that can be seen. `chain`
/// is the device at the place of the stroke, by its encoders.
///
/// The gyroscope decides what encoder and command have in common: sign, order, gear ratio. It knows
/// nothing of the joint's place, but the axis of joint i in S depends on the positions of the
/// joints between it and S alone: an axis that does not fit, after these were led as they should,
/// says that one of them counts from another zero.
std::string problem_of(const Stroke& stroke, const DeviceModel& device,
                       const model::ChainData& chain);

/// Axes of the joints in the sensor frame S, unit; zero for slides.
std::vector<Eigen::Vector3d> axes_in_sensor(const DeviceModel& device,
                                            const model::ChainData& chain);

/// What is wrong with joints that leave their places as soon as the drives hold them, by the change
/// of each encoder.
std::string problem_of_hold(const VectorPM& moved, const DeviceModel& device);

/// Dry friction of a joint of the manipulator that was led there and back, Nm: what turns its sign
/// with the motion, weight and springs do not.
double friction_of(const Stroke& there, const Stroke& back);

/// Angle between two directions, 0..pi, rad.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Name of a joint or axis of the gantry.
const std::string& name_of(const DeviceModel& device, int joint);

}  // namespace hg::commission
