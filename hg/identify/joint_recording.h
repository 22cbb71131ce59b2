/// The motion of all joints of a device, sample by sample, and its smoothing.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/simulation/simulation.h"
#include "hg/model/device_model.h"
#include "hg/recording/recording_reader.h"
#include "hg/signals/state.h"

namespace hg::identify {

/// A number of each joint (column) in each sample (row).
using Series = Eigen::MatrixXd;

/// Consecutive samples with the drives on. Angles are unwrapped.
struct JointMotion {
  Series q;         ///< joints as reported, rad
  Series theta;     ///< motors at the output of the gear, rad; no columns without such encoders
  Series tau;       ///< joint torques, Nm; no columns without such sensors
  Series command;   ///< commanded positions, rad
  Series q_p;       ///< gantry, m or rad
  Series wrench_S;  ///< reading of the force/torque sensor, in S, force first

  Eigen::Index samples() const { return q.rows(); }
};

/// Collects the samples of a recording.
class JointRecording {
 public:
  explicit JointRecording(const DeviceModel& device);

  /// Adds the next sample. Samples with drives off, shortly after they came on, or with values that
  /// are not finite are left out. Throws SetupError for a sample of a device with other joints.
  void add(const Sample& sample);

  std::vector<JointMotion> parts() const;  ///< stretches without gaps
  std::uint64_t samples() const { return samples_; }
  std::uint64_t used() const { return used_; }
  std::uint64_t gaps() const { return gaps_; }  ///< places where samples are missing

 private:
  struct Moment {
    VectorM q, theta, tau, command;
    VectorP q_p;
    Vector6 wrench_S;
  };
  void take(const Sample& sample);
  double unwrapped(int joint, double angle, double near) const;

  std::vector<bool> turns_;  // per joint: an angle
  int n_p_;
  double settling_;  // samples
  std::vector<std::vector<Moment>> parts_;
  std::uint64_t samples_ = 0, used_ = 0, gaps_ = 0, last_ = 0;
  int on_ = 0;
  bool is_cut_ = true;
};

/// What was read of a file.
struct RecordedJoints {
  config::SimulatedDeviceConfig device;
  std::vector<recording::Loss> losses;  ///< damaged parts of the recording
  std::vector<JointMotion> parts;
  double used_s = 0.0;  ///< time with the drives on, s
};

/// Reads a recording of `device`; empty = the device that it was made with. Throws SetupError, also
/// where the joints are those of another device or no sample has the drives on.
RecordedJoints read_joints(const std::string& file,
                           std::optional<config::SimulatedDeviceConfig> device);

/// Smooths by Hann's window of half width `half` samples, without delay; the first and last `half`
/// rows are not meaningful.
Series smoothed(const Series& x, int half);

/// Derivative by central differences, per second; the first and last row are 0.
Series slope(const Series& x, double period_s);

}  // namespace hg::identify
