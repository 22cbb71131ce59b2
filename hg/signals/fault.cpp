#include "hg/signals/fault.h"

namespace hg {

std::string_view to_string(FaultCode code) noexcept {
  switch (code) {
    case FaultCode::kNone:
      return "no fault";
    case FaultCode::kSensorNotFinite:
      return "measured value is not finite";
    case FaultCode::kSequenceGap:
      return "device skipped or repeated a sample";
    case FaultCode::kEmergencyStop:
      return "emergency stop";
    case FaultCode::kDeviceSilent:
      return "remote device is silent";
    case FaultCode::kDeviceGone:
      return "remote device has ended the session";
    case FaultCode::kSensorFrozen:
      return "measured value is frozen";
    case FaultCode::kSensorImplausible:
      return "sensors of a joint contradict each other";
    case FaultCode::kSensorJump:
      return "measured position jumped";
    case FaultCode::kClockWrong:
      return "clock of the device is wrong";
    case FaultCode::kBusErrors:
      return "fieldbus answers are missing";
    case FaultCode::kJointTorqueExceeded:
      return "joint torque exceeds its peak";
    case FaultCode::kTooHot:
      return "motor is too hot";
    case FaultCode::kDriveFault:
      return "drive reports a fault";
    case FaultCode::kTorqueUnexplained:
      return "joint torque that motion and user do not explain";
    case FaultCode::kTurnUnexplained:
      return "gyroscope and encoders contradict each other";
    case FaultCode::kMotionUnexplained:
      return "accelerometer and encoders contradict each other";
    case FaultCode::kMotorDeviates:
      return "motor torque differs from its command";
    case FaultCode::kCommandsLost:
      return "no new commands reached the device: lost or held up";
    case FaultCode::kOperatorReleased:
      return "operator released the enabling switch";
    case FaultCode::kScannerField:
      return "a person is in the scanner's field";
    case FaultCode::kSafetyInputsDisagree:
      return "channels of a safety input disagree";
    case FaultCode::kSafeSpeedExceeded:
      return "safely limited speed exceeded";
    case FaultCode::kCycleOverrun:
      return "cycles came too late too often";
    case FaultCode::kCollisionAhead:
      return "collision ahead";
    case FaultCode::kGantryExceeded:
      return "gantry exceeds its range or speed";
    case FaultCode::kGantryDeviates:
      return "gantry does not move as commanded";
    case FaultCode::kOscillation:
      return "hand and device shake each other";
    case FaultCode::kEnergy:
      return "device has given more energy than allowed";
    case FaultCode::kStopTooSlow:
      return "controlled stop took too long";
    case FaultCode::kAccelerationExceeded:
      return "acceleration rating exceeded";
    case FaultCode::kBrakingPosition:
      return "axis is off its braking ramp";
    case FaultCode::kBrakingSpeed:
      return "axis brakes too slowly";
    case FaultCode::kStopTooFar:
      return "axis moved too far in a stop";
    case FaultCode::kBrakesSlip:
      return "axis moves with its brake closed";
    case FaultCode::kWrenchTooLarge:
      return "user wrench exceeds the sensor's range";
    case FaultCode::kSolverFailed:
      return "rendering problem was not solved";
    case FaultCode::kReferenceNotFinite:
      return "rendering gave a value that is not finite";
    case FaultCode::kCommandNotFinite:
      return "control gave a value that is not finite";
    case FaultCode::kLimitExceeded:
      return "position limit exceeded";
    case FaultCode::kSpeedExceeded:
      return "speed rating exceeded";
    case FaultCode::kTrackingLost:
      return "device does not follow its reference";
    case FaultCode::kSyncLost:
      return "handle and twin are apart";
    case FaultCode::kLatencyGrew:
      return "latency of the torque loop has grown beyond what is stable";
  }
  return "unknown fault";
}

std::string_view to_string(Shaking shaking) noexcept {
  switch (shaking) {
    case Shaking::kNone:
      return "nothing";
    case Shaking::kForce:
      return "force of 3 to 30 Hz";
    case Shaking::kTorque:
      return "torque of 3 to 30 Hz";
    case Shaking::kFastForce:
      return "force above 30 Hz";
    case Shaking::kFastTorque:
      return "torque above 30 Hz";
    case Shaking::kBouncing:
      return "bouncing on a surface";
  }
  return "unknown";
}

}  // namespace hg
