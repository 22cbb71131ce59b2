/// Faults as data: they stop the device and are recorded and shown. Codes never change meaning.
#pragma once

#include <cstdint>
#include <string_view>

#include "hg/core/fields.h"

namespace hg {

enum class FaultCode : std::uint16_t {
  kNone = 0,
  kSensorNotFinite = 100,       ///< a measured value is NaN or infinite
  kSequenceGap = 101,           ///< the device skipped or repeated a sample
  kEmergencyStop = 102,         ///< a safety input requests a stop
  kDeviceSilent = 103,          ///< no message from a remote device for too long
  kDeviceGone = 104,            ///< a remote device ended the session
  kSensorFrozen = 105,          ///< a measured value is bitwise constant for too long
  kSensorImplausible = 106,     ///< motor, spring and link of a joint contradict each other
  kSensorJump = 107,            ///< a joint moved farther in one sample than physically possible
  kClockWrong = 108,            ///< the device's clock does not match its sample count
  kBusErrors = 109,             ///< too many samples in a row with missing fieldbus answers
  kWrenchTooLarge = 110,        ///< the user's force or torque exceeds the sensor's range
  kJointTorqueExceeded = 111,   ///< a joint torque exceeds its peak
  kTooHot = 112,                ///< a motor is hotter than allowed
  kDriveFault = 113,            ///< a drive reports a fault
  kMotorDeviates = 114,         ///< a motor does not deliver the commanded torque
  kTorqueUnexplained = 115,     ///< motion and user wrench do not explain a joint torque
  kTurnUnexplained = 116,       ///< gyroscope and encoders disagree on the rotation of the handle
  kMotionUnexplained = 117,     ///< accelerometer and encoders disagree on the handle's speed
  kCommandsLost = 120,          ///< no new commands reach the device
  kOperatorReleased = 130,      ///< the operator released the enabling switch
  kScannerField = 131,          ///< a person is in the scanner's field while the handle is free
  kSafetyInputsDisagree = 132,  ///< the two channels of a safety input disagree for too long
  kSafeSpeedExceeded = 133,     ///< the safely limited speed is exceeded
  kSolverFailed = 200,          ///< the rendering problem was not solved
  kReferenceNotFinite = 201,    ///< the rendering returned NaN or infinity
  kCommandNotFinite = 202,      ///< the control returned NaN or infinity
  kCycleOverrun = 203,          ///< too many late cycles
  kLimitExceeded = 300,         ///< a joint or frame exceeds its limit by more than the tolerance
  kSpeedExceeded = 301,         ///< a joint exceeds its speed rating
  kTrackingLost = 302,          ///< the device is too far from its reference
  kSyncLost = 303,              ///< handle and twin are too far apart
  kLatencyGrew = 304,           ///< command latency exceeds the stability bound of the torque loop
  kCollisionAhead = 305,  ///< later braking would end in a collision with itself or surroundings
  kGantryExceeded = 306,  ///< a gantry axis is beyond its range or its speed rating
  kGantryDeviates = 307,  ///< a gantry axis does not move as commanded
  kOscillation = 308,     ///< hand and device oscillate although damping was adapted
  kEnergy = 309,          ///< the device delivered more energy than its tank holds
  kStopTooSlow = 310,     ///< a controlled stop did not reach standstill in time
  kAccelerationExceeded = 311,  ///< the commanded acceleration of a joint exceeds its rating
  kBrakingPosition = 320,       ///< position of a braking axis deviates from its ramp
  kBrakingSpeed = 321,          ///< speed of a braking axis deviates from its ramp
  kStopTooFar = 322,            ///< a braking axis moved too far
  kBrakesSlip = 323,            ///< an axis moves with drive off and brake closed
};

/// Text of a fault code in one line, for example "measured value is not finite".
std::string_view to_string(FaultCode code) noexcept;

/// Kind of oscillation: Fault::index of FaultCode::kOscillation. Numbers never change meaning.
enum class Shaking : std::int16_t {
  kNone = -1,
  kForce = 0,       ///< 3 to 30 Hz
  kTorque = 1,      ///< 3 to 30 Hz
  kFastForce = 2,   ///< above 30 Hz
  kFastTorque = 3,  ///< above 30 Hz
  kBouncing = 4,    ///< the twin bounces off virtual surfaces and drives the hand
};

/// Text of a kind of oscillation, for example "torque of 3 to 30 Hz".
std::string_view to_string(Shaking shaking) noexcept;

/// One fault: code, place, and the compared values.
struct Fault {
  FaultCode code = FaultCode::kNone;
  std::int16_t index = -1;  ///< Joint, limit or component concerned; -1 = none
  double value = 0.0;       ///< Offending value
  double limit = 0.0;       ///< Limit that the value was compared with
};

template <typename Archive, Is<Fault> T>
void fields(Archive& a, T& fault) {
  a("code", fault.code, "cause, a number of hg/signals/fault.h; 0 = none");
  a("index", fault.index, "joint, limit or component; -1 = none");
  a("value", fault.value, "offending value");
  a("limit", fault.limit, "limit that the value was compared with");
}

}  // namespace hg
