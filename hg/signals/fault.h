/// Faults are data: they stop the device, are recorded and shown. Codes never change meaning.
#pragma once

#include <cstdint>
#include <string_view>

namespace hg {

enum class FaultCode : std::uint16_t {
  kNone = 0,
  kSensorNotFinite = 100,      ///< a measured value is NaN or infinite
  kSequenceGap = 101,          ///< the device skipped or repeated a sample
  kEmergencyStop = 102,        ///< the safety inputs asked for a stop
  kDeviceSilent = 103,         ///< nothing was heard from a remote device for too long
  kDeviceGone = 104,           ///< a remote device has ended the session
  kSensorFrozen = 105,         ///< a measured value shows the same bits for too long
  kSensorImplausible = 106,    ///< motor, spring and link of a joint contradict each other
  kSensorJump = 107,           ///< a joint moved farther in one sample than it can
  kClockWrong = 108,           ///< the device's clock does not keep step with its samples
  kBusErrors = 109,            ///< too many samples in a row with missing fieldbus answers
  kWrenchTooLarge = 110,       ///< the user's force or torque exceeds the sensor's range
  kJointTorqueExceeded = 111,  ///< a joint carries more than its peak torque
  kTooHot = 112,               ///< a motor is hotter than allowed
  kDriveFault = 113,           ///< a drive says that it has a fault
  kMotorDeviates = 114,        ///< a motor does not give the torque that it is told
  kTorqueUnexplained = 115,    ///< motion and user's wrench do not explain a joint torque
  kTurnUnexplained = 116,      ///< the gyroscope turns otherwise than the encoders say
  kMotionUnexplained = 117,    ///< the handle gets faster than the encoders say
  kCommandsLost = 120,         ///< no new commands have reached the device
  kOperatorReleased = 130,     ///< the operator let go of the enabling switch
  kScannerField = 131,         ///< somebody is in the scanner's field while nobody holds the handle
  kSafetyInputsDisagree = 132,  ///< the two channels of a safety input differ for too long
  kSafeSpeedExceeded = 133,     ///< faster than the safely limited speed
  kSolverFailed = 200,          ///< the rendering problem was not solved
  kReferenceNotFinite = 201,    ///< the rendering gave NaN or infinity
  kCommandNotFinite = 202,      ///< the control gave NaN or infinity
  kCycleOverrun = 203,          ///< cycles came too late too often
  kLimitExceeded = 300,         ///< a joint or frame left its limit by more than the tolerance
  kSpeedExceeded = 301,         ///< a joint is faster than its rating allows
  kTrackingLost = 302,          ///< the device is too far from its reference
  kSyncLost = 303,              ///< handle and twin are too far apart
  kLatencyGrew = 304,           ///< commands reach the drives later than the torque loop can bear
  kCollisionAhead = 305,  ///< the device would hit itself or its surroundings if it braked later
  kGantryExceeded = 306,  ///< a gantry axis is beyond its range or its speed rating
  kGantryDeviates = 307,  ///< a gantry axis does not move as commanded
  kOscillation = 308,     ///< hand and device shake each other and adaptation did not end it
  kEnergy = 309,          ///< the device has given more energy than its tank holds
  kStopTooSlow = 310,     ///< a controlled stop did not come to rest in time
  kAccelerationExceeded = 311,  ///< a joint is asked to accelerate more than its rating allows
  kBrakingPosition = 320,  ///< an axis that is being stopped is not where its braking ramp takes it
  kBrakingSpeed = 321,     ///< an axis that is being stopped has not the speed of its braking ramp
  kStopTooFar = 322,       ///< an axis that is being stopped has moved too far
  kBrakesSlip = 323,       ///< an axis moves although its drive is off and its brake closed
};

/// One line for humans, for example "measured value is not finite".
std::string_view to_string(FaultCode code) noexcept;

/// What shakes, with FaultCode::kOscillation: Fault::index. Numbers never change meaning.
enum class Shaking : std::int16_t {
  kNone = -1,
  kForce = 0,       ///< 3 to 30 Hz
  kTorque = 1,      ///< 3 to 30 Hz
  kFastForce = 2,   ///< above 30 Hz
  kFastTorque = 3,  ///< above 30 Hz
  kBouncing = 4,    ///< the twin bounces off virtual surfaces and drives the hand
};

/// "torque of 3 to 30 Hz"
std::string_view to_string(Shaking shaking) noexcept;

struct Fault {
  FaultCode code = FaultCode::kNone;
  std::int16_t index = -1;  ///< joint, limit or component it concerns; -1 = none
  double value = 0.0;       ///< the offending value
  double limit = 0.0;       ///< what it was compared with
};

}  // namespace hg
