/// Postures of a device drawn at random within its limits, and what it can do in each.
///
/// Deterministic: the same device and seed give the same numbers. Set-up code: it allocates.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "hg/config/device.h"
#include "hg/inspection/capability.h"

namespace hg::inspection {

struct SurveyOptions {
  std::uint64_t seed = 1;
  int postures = 20'000;   ///< with forces: percentiles steady to two digits
  int positions = 60'000;  ///< of the arm, for the workspace; each with several of the gantry
};

/// Where the device's joints may be, gantry first; what is unlimited as model::finite_range says.
struct JointRanges {
  Eigen::VectorXd lower, upper;
};
JointRanges joint_ranges(const config::Device& device);

/// Uniform numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// In [0, 1).
  double next() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

/// Whether the virtual joints of the device permit `q` (gantry first).
bool permits_virtual_joints(const rendering::DeviceModel& model, const Eigen::VectorXd& q);
/// Whether all Cartesian limits permit the posture to which the chain has been updated.
bool permits_boxes(const rendering::DeviceModel& model, const model::Chain& chain);

/// Uniform in the joint ranges, virtual joints respected. With `at_limits` every joint stands at
/// one of its limits with a chance of 1/5, so that the edges of the workspace are met. Empty when
/// 1000 tries have failed.
std::optional<Eigen::VectorXd> draw(const config::Device& device, const JointRanges& ranges,
                                    bool at_limits, Random& random);

/// One posture within all limits, Cartesian ones included.
struct Posture {
  Eigen::VectorXd q;       ///< gantry first
  Eigen::Vector3d handle;  ///< m, in B
  Guarantee force;         ///< N; joint: index in the chain
  Guarantee torque;        ///< Nm
  Guarantee acceleration;  ///< m/s^2; joint: index in the manipulator
  Conditioning conditioning;
  bool has_paper_wrench = false;  ///< 50 N and 10 Nm at once, in any directions, [HG] III-B
};

/// A point that the handle reaches within all limits.
struct Position {
  Eigen::Vector3d p;   ///< m, in B
  double force = 0.0;  ///< N, in the worst direction
};

struct Cloud {
  std::vector<Position> positions;
  std::vector<Eigen::AlignedBox3d> frames;  ///< per Cartesian limit: of its frame, boxes ignored
  double reach = 0.0;  ///< m, handle from the axis of the first joint of the arm; 0 = no axis
};

/// Moves a posture that was drawn; false = leave it out. May update the chain as it likes.
using Adjust = std::function<bool(model::Chain& chain, Eigen::VectorXd& q)>;

/// `postures` of the arm, each with several positions of a gantry that only shifts it.
Cloud cloud(const config::Device& device, int postures, bool at_limits, Random& random,
            const Adjust& adjust = {});

struct Survey {
  SurveyOptions options;
  double length = 1.0;  ///< m, scales the Jacobian: mean of |J linear| / |J angular|
  std::vector<Posture> postures;
  int drawn = 0;                ///< postures within the joint limits tried for these
  Cloud cloud;                  ///< drawn with at_limits
  Eigen::VectorXd gravity_max;  ///< largest holding torque of each joint, gantry first
  Posture most_singular;        ///< found by descent from the worst postures
};

Survey survey(const config::Device& device, const SurveyOptions& options = {});

/// Manipulator columns of the Jacobian of `frame`.
MatrixJ manipulator_jacobian(const rendering::DeviceModel& model, const model::Chain& chain,
                             int frame);

}  // namespace hg::inspection
