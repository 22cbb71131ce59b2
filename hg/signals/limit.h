/// Interface of the limits: a catalogue made at set-up and a report per cycle.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/fields.h"
#include "hg/core/interval.h"
#include "hg/core/types.h"

namespace hg {

/// Kind of a limit, in the order of the catalogue: device first, then twin; within these by the
/// priorities of [HG] Table II, motors between virtual joints and frames, self-collision behind
/// them.
enum class LimitKind : std::uint8_t {
  kManipulatorJoint = 0,
  kVirtualJoint = 1,
  kMotor = 2,  ///< motor torque of the manipulator; without distances to its ends
  kCartesian = 3,
  kTwinJoint = 4,
  kSelfCollision = 5,  ///< foreseen distance of the device's shapes beyond the safe one; last of it
};

inline constexpr int kMaxLimits =
    2 * kMaxManipulator + kMaxVirtualJoints + 3 * kMaxCartesianFrames + 1 + kMaxTwin;

/// One limited quantity. Its LimitReport has the same index as its entry in the catalogue.
struct LimitInfo {
  LimitKind kind;
  std::string name;  ///< For example "m4", "q4+q5", "elbow x", "hinge"
  bool is_angle;     ///< true: position in rad, reaction in Nm; false: m and N
  Interval range;    ///< Configured position range
};

using LimitCatalogue = std::vector<LimitInfo>;

enum class LimitState : std::uint8_t { kInactive = 0, kLower = 1, kUpper = 2, kViolated = 3 };

/// Rating of the limited quantity that is active while its state is not kInactive.
enum class LimitCause : std::uint8_t {
  kNone = 0,
  kPosition = 1,
  kVelocity = 2,
  kAcceleration = 3,
  kLock = 4,           ///< a lock fixes the joint
  kLatch = 5,          ///< a latch lets the joint close but not open
  kFriction = 6,       ///< Coulomb friction holds the joint
  kContradiction = 7,  ///< limits of the joint contradict: held between them or at the lock
  kTorque = 8,         ///< the motor is at the largest torque available to the law
  kTorqueRate = 9,     ///< the motor's torque cannot change faster, while there is more of it
  kWeight = 10,        ///< further out the motor could not hold the weight of the arm and a hand
  kBraking = 11,       ///< any faster, the device could not stop before this and its other limits
};

std::string_view to_string(LimitKind kind) noexcept;
std::string_view to_string(LimitState state) noexcept;
std::string_view to_string(LimitCause cause) noexcept;

/// State of one limit in one cycle.
struct LimitReport {
  LimitState state = LimitState::kInactive;
  LimitCause cause = LimitCause::kNone;
  double position = 0.0;
  double to_lower = kInfinity;
  double to_upper = kInfinity;
  double excess = 0.0;
  double slack = 0.0;
  double reaction = 0.0;
};

template <typename Archive, Is<LimitReport> T>
void fields(Archive& a, T& report) {
  a("state", report.state);
  a("cause", report.cause);
  a("position", report.position, "position of the limited quantity", unit::kJointPosition);
  a("to_lower", report.to_lower, "distance to the lower limit as rendered, with margin and locks",
    unit::kJointPosition);
  a("to_upper", report.to_upper, "distance to the upper limit as rendered, with margin and locks",
    unit::kJointPosition);
  a("excess", report.excess, "distance outside the configured range, >= 0", unit::kJointPosition);
  a("slack", report.slack, "acceleration by which a violated row misses its bound",
    unit::kJointAcceleration);
  a("reaction", report.reaction, "constraint force or torque in the quantity's own coordinate",
    unit::kJointTorque);
}

}  // namespace hg
