/// How well a device serves a human arm: coverage, force, inertia and eigenfrequencies over the
/// poses of the hand.
///
/// Sources: [HG] III-B, [HANDBOOK] 8.2 to 8.4. Only the manipulator counts: the gantry stands still
/// while a force, speed or acceleration is judged, and is free to be anywhere else. SI units.
///
/// Poses of a HapticGiant, of any lengths, are reached in the posture of its gantry target in
/// closed form, 10 us each; those of other devices by numerical inverse kinematics, 50 ms each.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hg/config/device.h"
#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/design/human_capability.h"
#include "hg/model/device_model.h"
#include "hg/model/haptic_giant.h"

namespace hg::design {

/// How the hand holds the handle.
enum class Grip {
  kAcross,  ///< Along x of the handle, as the HapticGiant's: z of the handle points to the user
  kAlong  ///< Along z of the handle, a rod that continues the flange: z points to the little finger
};

/// Orientation of the handle in the frame of the hand.
Eigen::Matrix3d hand_to_handle(Grip grip) noexcept;

/// What a DeviceModel does not say, and how it is judged.
struct MetricOptions {
  double floor_z = 0.0;      ///< Height of the floor in B, m
  double moving_mass = 0.0;  ///< Mass of everything that the arm moves, kg; only copied
  Grip grip = Grip::kAcross;
  /// Pose of the person (frame F) in B; none: place_person()
  std::optional<Pose> T_B_F = {};
  int directions = 64;          ///< Directions in which radii of ellipsoids are compared
  double length = 0.3;          ///< Length that makes rows of the Jacobian comparable, m
  double condition_max = 20.0;  ///< Condition number above which a posture counts as singular
  double force = 50.0;          ///< Force to be held in any direction, N
  double torque = 10.0;         ///< Torque to be held in any direction, Nm
  bool keeps_poses = false;     ///< Fills DeviceMetrics::poses
};

/// The options of a device as loaded: floor, moving mass, grip by its kinematics.
MetricOptions metric_options(const config::DeviceConfig& device);

/// One pose of the hand, as the device serves it.
struct PoseMetrics {
  bool is_reached = false;                             ///< Without it all below is zero
  Eigen::VectorXd q;                                   ///< Posture, gantry first
  double velocity = 0.0, turn_velocity = 0.0;          ///< Coverage, 0 to 1
  double acceleration = 0.0, turn_acceleration = 0.0;  ///< Coverage, 0 to 1
  double force = 0.0, torque = 0.0;                    ///< In the worst direction, N and Nm
  bool holds_wrench = false;                           ///< MetricOptions::force and torque at once
  double condition = 0.0;                              ///< Condition number of the scaled Jacobian
  double mass = 0.0, mass_worst = 0.0;  ///< Reflected mass: mean, worst direction, kg
  double frequency = 0.0;               ///< Lowest eigenfrequency, handle free, Hz
};

/// A quantity over the reached poses, weighted.
struct Quantiles {
  double least = 0.0, low = 0.0, median = 0.0;  ///< Smallest, 5 % quantile, median
};

/// Shares and means are weighted by the poses.
struct DeviceMetrics {
  int poses = 0;      ///< Number of poses of the hand
  int reached = 0;    ///< Number of those that the device reaches
  double pose = 0.0;  ///< Coverage of poses: share that the device reaches
  /// Coverage of the hand's speeds and accelerations, linear and angular: mean over all poses, zero
  /// where the device cannot be, of the mean over directions of min(1, device's / hand's radius)
  double velocity = 0.0, turn_velocity = 0.0;
  double acceleration = 0.0, turn_acceleration = 0.0;

  // over the reached poses
  bool has_torques =
      false;                ///< Torques of all joints are known; else force and torque are infinite
  Quantiles force, torque;  ///< In the worst direction, N and Nm
  double share_force = 0.0;    ///< Share that holds MetricOptions::force in any direction
  double share_torque = 0.0;   ///< Share that holds MetricOptions::torque in any direction
  double share_wrench = 0.0;   ///< Share that holds both at once
  double share_regular = 0.0;  ///< Share without singularity, see MetricOptions::condition_max

  double moving_mass = 0.0;  ///< kg
  /// Reflected mass at the handle, motors included, joints rigid and the handle free to turn: mean
  /// over poses of the mean over directions, and 95 % quantile of the worst direction, kg
  double mass_mean = 0.0, mass_worst = 0.0;
  /// Lowest eigenfrequencies of the elastic joints, Hz; zero without actuators. Handle free, motors
  /// held: median and smallest over poses. Handle clamped, motors free: the same in all postures.
  double frequency_median = 0.0, frequency_least = 0.0, frequency_clamped = 0.0;

  std::vector<PoseMetrics> each;  ///< With MetricOptions::keeps_poses, in the order of the poses
};

/// Measures a device. Throws SetupError for options out of range or a capability without poses.
DeviceMetrics measure(const DeviceModel& device, const HumanCapability& human,
                      const MetricOptions& options = {});

/// The lengths of a HapticGiant, if the device is one: kinematics in closed form, unlimited m1.
std::optional<model::haptic_giant::Lengths> closed_form(const DeviceModel& device);

/// Pose of the person in B: the middle of the hand's poses is where the device's posture holds the
/// handle, and the hand points as the handle says; on the floor.
Pose place_person(const DeviceModel& device, const HumanCapability& human,
                  const MetricOptions& options);

/// Mean over directions of min(1, radius of `device` / radius of `human`), of two ellipsoids by
/// their shape matrices; zero where `device` is flat. `directions`: unit vectors.
double relative_coverage(const Eigen::Matrix3d& device, const Eigen::Matrix3d& human,
                         const std::vector<Eigen::Vector3d>& directions);

/// `count` unit vectors spread evenly over a half sphere (a Fibonacci spiral): an ellipsoid has the
/// same radius on its other side.
std::vector<Eigen::Vector3d> half_sphere(int count);

}  // namespace hg::design
