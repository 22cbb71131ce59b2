/// Random postures of a device within its limits, and its capability in each.
///
/// Deterministic: the same device and seed give the same numbers. Set-up code: it allocates.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "hg/config/device.h"
#include "hg/core/random.h"
#include "hg/model/capability.h"
#include "hg/model/chain_data.h"

namespace hg::workspace {

struct SurveyOptions {
  std::uint64_t seed = 1;
  int postures = 20'000;  ///< number of postures with forces: percentiles steady to two digits
  /// Number of arm postures for the workspace, each with several gantry positions
  int positions = 60'000;
};

/// Ranges of the device's joints, gantry first; unlimited joints as in model::finite_range.
struct JointRanges {
  Eigen::VectorXd lower, upper;
};
JointRanges joint_ranges(const config::DeviceConfig& device);

/// Whether the virtual joints of the device permit `q` (gantry first).
bool permits_virtual_joints(const DeviceModel& model, const Eigen::VectorXd& q);
/// Whether all Cartesian limits permit the posture of `chain`, after update_poses().
bool permits_boxes(const DeviceModel& model, const model::ChainData& chain);

/// Draws a posture uniformly in the joint ranges, respecting virtual joints. With `at_limits` every
/// joint stands at one of its limits with a chance of 1/5, so that the edges of the workspace are
/// reached. Empty after 1000 failed tries.
std::optional<Eigen::VectorXd> draw(const config::DeviceConfig& device, const JointRanges& ranges,
                                    bool at_limits, Random& random);

/// One posture within all limits, Cartesian ones included.
struct Posture {
  Eigen::VectorXd q;        ///< positions, gantry first
  Eigen::Vector3d handle;   ///< position of the handle in B, m
  model::Guarantee force;   ///< guaranteed force, N; joint: index in the chain
  model::Guarantee torque;  ///< guaranteed torque, Nm
  model::Guarantee
      acceleration;  ///< guaranteed acceleration, m/s^2; joint: index in the manipulator
  model::Conditioning conditioning;
  /// Provides 50 N and 10 Nm at once, in any directions, [HG] III-B
  bool has_paper_wrench = false;
};

/// A point that the handle reaches within all limits.
struct Position {
  Eigen::Vector3d p;   ///< position in B, m
  double force = 0.0;  ///< force in the worst direction, N
};

struct Cloud {
  std::vector<Position> positions;
  /// Box per Cartesian limit reached by its frame, boxes ignored
  std::vector<Eigen::AlignedBox3d> frames;
  /// Distance of the handle from the axis of the arm's first joint, m; 0 = no axis
  double reach = 0.0;
};

/// Callback that moves a drawn posture; false = leave it out. May update the chain as it likes.
using Adjust = std::function<bool(model::ChainData& chain, Eigen::VectorXd& q)>;

/// Draws `postures` of the arm, each with several positions of a gantry that only shifts it.
Cloud cloud(const config::DeviceConfig& device, int postures, bool at_limits, Random& random,
            const Adjust& adjust = {});

struct Survey {
  SurveyOptions options;
  double length = 1.0;  ///< length that scales the Jacobian, m: mean of |J linear| / |J angular|
  std::vector<Posture> postures;
  int drawn = 0;                ///< number of postures within the joint limits tried
  Cloud cloud;                  ///< cloud drawn with at_limits
  Eigen::VectorXd gravity_max;  ///< largest holding torque of each joint, gantry first
  Posture most_singular;        ///< most singular posture, found by descent from the worst ones
};

Survey survey(const config::DeviceConfig& device, const SurveyOptions& options = {});

/// Manipulator columns of the Jacobian of `frame`; `chain`: after update_kinematics().
model::Jacobian manipulator_jacobian(const DeviceModel& model, const model::ChainData& chain,
                                     int frame);

}  // namespace hg::workspace
