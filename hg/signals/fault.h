/// Faults as data: they stop the device and are recorded and shown. Codes never change meaning.
#pragma once

#include <cstdint>
#include <string_view>

#include "hg/core/fields.h"

namespace hg {

/// Causes of a stop. Their words are in one table, kFaults of fault.cpp.
enum class FaultCode : std::uint16_t {
  kNone = 0,
  kSensorNotFinite = 100,
  kSequenceGap = 101,
  kEmergencyStop = 102,
  kDeviceSilent = 103,
  kDeviceGone = 104,
  kSensorFrozen = 105,
  kSensorImplausible = 106,
  kSensorJump = 107,
  kClockWrong = 108,
  kBusErrors = 109,
  kWrenchTooLarge = 110,
  kJointTorqueExceeded = 111,
  kTooHot = 112,
  kDriveFault = 113,
  kMotorDeviates = 114,
  kTorqueUnexplained = 115,
  kTurnUnexplained = 116,
  kMotionUnexplained = 117,
  kSensorIncomplete = 118,
  kCommandsLost = 120,
  kOperatorReleased = 130,
  kScannerField = 131,
  kSafetyInputsDisagree = 132,
  kSafeSpeedExceeded = 133,
  kTwinForceWrong = 140,
  kSolverFailed = 200,
  kReferenceNotFinite = 201,
  kCommandNotFinite = 202,
  kCycleOverrun = 203,
  kLimitExceeded = 300,
  kSpeedExceeded = 301,
  kTrackingLost = 302,
  kSyncLost = 303,
  kLatencyGrew = 304,
  kCollisionAhead = 305,
  kGantryExceeded = 306,
  kGantryDeviates = 307,
  kOscillation = 308,
  kEnergy = 309,
  kStopTooSlow = 310,
  kAccelerationExceeded = 311,
  kBrakingPosition = 320,
  kBrakingSpeed = 321,
  kStopTooFar = 322,
  kBrakesSlip = 323,
  kLimitNotHeld = 324,
};

/// Words for a fault, the same in messages, recordings, Python and docs.
struct FaultWords {
  FaultCode code = FaultCode::kNone;
  std::string_view name;     ///< Two or three words, for example "sensor not finite"
  std::string_view text;     ///< One line for messages, for example "measured value is not finite"
  std::string_view meaning;  ///< Explanation in whole sentences
};

/// Words for `code`; for an unknown code those of an unknown fault.
const FaultWords& fault_words(FaultCode code) noexcept;

/// Text of a fault code in one line: fault_words(code).text.
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
  std::int16_t index = -1;
  double value = 0.0;
  double limit = 0.0;
};

template <typename Archive, Is<Fault> T>
void fields(Archive& a, T& fault) {
  a("code", fault.code, "cause, a number of hg/signals/fault.h; 0 = none");
  a("index", fault.index, "joint, limit or component concerned; -1 = none");
  a("value", fault.value, "offending value, in the unit of the rule", unit::kNone);
  a("limit", fault.limit, "limit that the value was compared with", unit::kNone);
}

}  // namespace hg
