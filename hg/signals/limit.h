/// Limits as the rest of the program sees them: a catalogue made at set-up, a report per cycle.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"

namespace hg {

/// Order of the catalogue: device first, then twin; within, the priorities of [HG] Table II, motors
/// between virtual joints and frames.
enum class LimitKind : std::uint8_t {
  kManipulatorJoint = 0,
  kVirtualJoint = 1,
  kMotor = 2,  ///< torque of a motor of the manipulator; has no distance to its ends
  kCartesian = 3,
  kTwinJoint = 4,
};

inline constexpr int kMaxLimits =
    2 * kMaxManipulator + kMaxVirtualJoints + 3 * kMaxCartesianFrames + kMaxTwin;

/// One limited quantity. Its index in the catalogue is the index of its LimitReport.
struct LimitInfo {
  LimitKind kind;
  std::string name;  ///< "m4", "q4+q5", "elbow x", "hinge"
  bool is_angle;     ///< position in rad and reaction in Nm; otherwise m and N
  Interval range;    ///< configured positions
};

using LimitCatalogue = std::vector<LimitInfo>;

enum class LimitState : std::uint8_t { kInactive = 0, kLower = 1, kUpper = 2, kViolated = 3 };

/// Which rating of the limited quantity acts while its state is not kInactive.
enum class LimitCause : std::uint8_t {
  kNone = 0,
  kPosition = 1,
  kVelocity = 2,
  kAcceleration = 3,
  kLock = 4,           ///< a lock holds the joint
  kLatch = 5,          ///< a latch lets the joint close but not open
  kFriction = 6,       ///< Coulomb friction holds the joint
  kContradiction = 7,  ///< no position meets all limits of the joint: held between or at the lock
  kTorque = 8,         ///< the motor gives all the torque that the law may ask it for
};

std::string_view to_string(LimitKind kind) noexcept;
std::string_view to_string(LimitState state) noexcept;
std::string_view to_string(LimitCause cause) noexcept;

struct LimitReport {
  LimitState state = LimitState::kInactive;
  LimitCause cause = LimitCause::kNone;
  double position = 0.0;        ///< of the limited quantity
  double to_lower = kInfinity;  ///< distance left to the limit as rendered: with margin and locks
  double to_upper = kInfinity;
  double excess = 0.0;    ///< how far it is outside its configured range, >= 0
  double slack = 0.0;     ///< acceleration by which a violated row misses its bound
  double reaction = 0.0;  ///< constraint force or torque in the quantity's own coordinate
};

}  // namespace hg
