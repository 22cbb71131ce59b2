#include "hg/signals/limit.h"

namespace hg {

std::string_view to_string(LimitKind kind) noexcept {
  switch (kind) {
    case LimitKind::kManipulatorJoint:
      return "manipulator";
    case LimitKind::kVirtualJoint:
      return "virtual";
    case LimitKind::kCartesian:
      return "cartesian";
    case LimitKind::kMotor:
      return "motor";
    case LimitKind::kTwinJoint:
      return "twin";
    case LimitKind::kSelfCollision:
      return "self_collision";
  }
  return "unknown";
}

std::string_view to_string(LimitState state) noexcept {
  switch (state) {
    case LimitState::kInactive:
      return "inactive";
    case LimitState::kLower:
      return "lower";
    case LimitState::kUpper:
      return "upper";
    case LimitState::kViolated:
      return "violated";
  }
  return "unknown";
}

std::string_view to_string(LimitCause cause) noexcept {
  switch (cause) {
    case LimitCause::kNone:
      return "none";
    case LimitCause::kPosition:
      return "position";
    case LimitCause::kVelocity:
      return "velocity";
    case LimitCause::kAcceleration:
      return "acceleration";
    case LimitCause::kLock:
      return "lock";
    case LimitCause::kLatch:
      return "latch";
    case LimitCause::kFriction:
      return "friction";
    case LimitCause::kContradiction:
      return "contradiction";
    case LimitCause::kTorque:
      return "torque";
    case LimitCause::kWeight:
      return "weight";
    case LimitCause::kTorqueRate:
      return "torque_rate";
    case LimitCause::kBraking:
      return "braking";
  }
  return "unknown";
}

}  // namespace hg
