#include "hg/signals/fault.h"

#include <cstddef>
#include <iterator>

namespace hg {
namespace {

constexpr FaultWords kFaults[] = {
    {.code = FaultCode::kNone,
     .name = "no fault",
     .text = "no fault",
     .meaning = "Nothing is wrong."},
    {.code = FaultCode::kSensorNotFinite,
     .name = "sensor not finite",
     .text = "measured value is not finite",
     .meaning = "A sensor gives a value that is not a number or infinite."},
    {.code = FaultCode::kSequenceGap,
     .name = "sequence gap",
     .text = "device skipped or repeated a sample",
     .meaning = "The device skipped a sample or repeated one."},
    {.code = FaultCode::kEmergencyStop,
     .name = "emergency stop",
     .text = "emergency stop",
     .meaning = "A stop button is pressed, or the safety controller has tripped."},
    {.code = FaultCode::kDeviceSilent,
     .name = "device silent",
     .text = "remote device is silent",
     .meaning = "A remote device was silent for too long."},
    {.code = FaultCode::kDeviceGone,
     .name = "device gone",
     .text = "remote device has ended the session",
     .meaning = "A remote device has ended the session."},
    {.code = FaultCode::kSensorFrozen,
     .name = "sensor frozen",
     .text = "measured value is frozen",
     .meaning = "A sensor with noise shows the same bits again and again."},
    {.code = FaultCode::kSensorImplausible,
     .name = "sensors contradict",
     .text = "sensors of a joint contradict each other",
     .meaning =
         "Motor encoder, joint torque sensor and link encoder of a joint do not fit together."},
    {.code = FaultCode::kSensorJump,
     .name = "position jump",
     .text = "measured position jumped",
     .meaning = "A measured position moved farther in one sample than the joint can."},
    {.code = FaultCode::kClockWrong,
     .name = "clock wrong",
     .text = "clock of the device is wrong",
     .meaning = "The device's clock does not keep step with its samples."},
    {.code = FaultCode::kBusErrors,
     .name = "fieldbus answers missing",
     .text = "fieldbus answers are missing",
     .meaning = "Devices on the fieldbus did not answer in samples that follow each other."},
    {.code = FaultCode::kWrenchTooLarge,
     .name = "user wrench",
     .text = "user wrench exceeds the sensor's range",
     .meaning = "The user pulls or turns harder than the sensor and the person should bear."},
    {.code = FaultCode::kJointTorqueExceeded,
     .name = "joint torque",
     .text = "joint torque exceeds its peak",
     .meaning = "A joint carries more than the peak torque of its actuator."},
    {.code = FaultCode::kTooHot,
     .name = "motor too hot",
     .text = "motor is too hot",
     .meaning = "A motor is hotter than allowed."},
    {.code = FaultCode::kDriveFault,
     .name = "drive fault",
     .text = "drive reports a fault",
     .meaning = "A drive reports a fault."},
    {.code = FaultCode::kMotorDeviates,
     .name = "motor torque",
     .text = "motor torque differs from its command",
     .meaning = "A motor does not give the commanded torque."},
    {.code = FaultCode::kTorqueUnexplained,
     .name = "unexplained torque",
     .text = "joint torque that motion and user do not explain",
     .meaning = "Something but the hand at the handle pushes the arm, or force sensor and joint "
                "torques contradict each other."},
    {.code = FaultCode::kTurnUnexplained,
     .name = "gyroscope contradicts",
     .text = "gyroscope and encoders contradict each other",
     .meaning = "The handle turns otherwise than the encoders of the joints say: an encoder "
                "drifts, or the gyroscope does."},
    {.code = FaultCode::kMotionUnexplained,
     .name = "accelerometer contradicts",
     .text = "accelerometer and encoders contradict each other",
     .meaning = "The handle gets faster than the encoders of gantry and joints say: a coupling or "
                "belt slips, encoders drift, or the accelerometer is wrong."},
    {.code = FaultCode::kSensorIncomplete,
     .name = "sensor incomplete",
     .text = "sample has the wrong number of values",
     .meaning = "The driver gives more or fewer values of a sensor than the device has joints or "
                "axes, or leaves out motor encoders or torque sensors that the control needs."},
    {.code = FaultCode::kCommandsLost,
     .name = "commands lost",
     .text = "no new commands reached the device: lost or held up",
     .meaning = "No new command has reached the device for too long: lost or held up on the way, "
                "or this computer was late."},
    {.code = FaultCode::kOperatorReleased,
     .name = "operator let go",
     .text = "operator released the enabling switch",
     .meaning = "The operator let go of the enabling switch, or squeezed it through."},
    {.code = FaultCode::kScannerField,
     .name = "scanner field",
     .text = "a person is in the scanner's field",
     .meaning = "A person is in the scanner's field while the handle is not held."},
    {.code = FaultCode::kSafetyInputsDisagree,
     .name = "safety inputs disagree",
     .text = "channels of a safety input disagree",
     .meaning = "The two channels of a safety input differed for too long."},
    {.code = FaultCode::kSafeSpeedExceeded,
     .name = "safe speed",
     .text = "safely limited speed exceeded",
     .meaning =
         "While the handle was not held, the device was faster than the safely limited speed."},
    {.code = FaultCode::kTwinForceWrong,
     .name = "remote force",
     .text = "force on the twin, or motion of its base, cannot be used",
     .meaning = "The force that a remote machine sends to the twin is not a number, larger than is "
                "allowed on the handle, or has no value for each joint; or the motion of the "
                "twin's base is not a number or too fast."},
    {.code = FaultCode::kSolverFailed,
     .name = "solver failed",
     .text = "rendering problem was not solved",
     .meaning = "The rendering problem of a cycle was not solved."},
    {.code = FaultCode::kReferenceNotFinite,
     .name = "reference not finite",
     .text = "rendering gave a value that is not finite",
     .meaning = "The rendering gave a value that is not a number or infinite."},
    {.code = FaultCode::kCommandNotFinite,
     .name = "command not finite",
     .text = "control gave a value that is not finite",
     .meaning = "The control gave a value that is not a number or infinite."},
    {.code = FaultCode::kCycleOverrun,
     .name = "cycles late",
     .text = "cycles came too late too often",
     .meaning = "Cycles of the loop came too late too often."},
    {.code = FaultCode::kLimitExceeded,
     .name = "position limit",
     .text = "position limit exceeded",
     .meaning =
         "A joint, a sum of joints or a frame is outside its limit by more than the tolerance."},
    {.code = FaultCode::kSpeedExceeded,
     .name = "joint speed",
     .text = "speed rating exceeded",
     .meaning = "A joint is faster than its rating allows."},
    {.code = FaultCode::kTrackingLost,
     .name = "tracking",
     .text = "device does not follow its reference",
     .meaning = "A joint is too far from its reference."},
    {.code = FaultCode::kSyncLost,
     .name = "handle and twin apart",
     .text = "handle and twin are apart",
     .meaning = "Handle and twin are too far apart."},
    {.code = FaultCode::kLatencyGrew,
     .name = "latency grew",
     .text = "latency of the torque loop has grown beyond what is stable",
     .meaning = "Commands reach the drives later than the torque loop can bear."},
    {.code = FaultCode::kCollisionAhead,
     .name = "collision ahead",
     .text = "collision ahead",
     .meaning = "The device would hit itself or its surroundings if it braked any later."},
    {.code = FaultCode::kGantryExceeded,
     .name = "gantry range or speed",
     .text = "gantry exceeds its range or speed",
     .meaning = "An axis of the gantry is beyond its range or faster than its drive may be."},
    {.code = FaultCode::kGantryDeviates,
     .name = "gantry deviates",
     .text = "gantry does not move as commanded",
     .meaning = "An axis of the gantry does not move as commanded."},
    {.code = FaultCode::kOscillation,
     .name = "oscillation",
     .text = "hand and device shake each other",
     .meaning = "Hand and device shake each other, or a body bounces off a surface and drives the "
                "hand, and it does not end."},
    {.code = FaultCode::kEnergy,
     .name = "energy",
     .text = "device has given more energy than allowed",
     .meaning = "The device has given more energy than its tank holds."},
    {.code = FaultCode::kStopTooSlow,
     .name = "stop too slow",
     .text = "controlled stop took too long",
     .meaning = "A controlled stop did not come to rest in time."},
    {.code = FaultCode::kAccelerationExceeded,
     .name = "joint acceleration",
     .text = "acceleration rating exceeded",
     .meaning = "The reference of a joint accelerates more than its rating allows."},
    {.code = FaultCode::kBrakingPosition,
     .name = "off the braking ramp",
     .text = "axis is off its braking ramp",
     .meaning = "An axis that is being stopped is not where its braking ramp takes it."},
    {.code = FaultCode::kBrakingSpeed,
     .name = "brakes too slowly",
     .text = "axis brakes too slowly",
     .meaning = "An axis that is being stopped does not have the speed of its braking ramp."},
    {.code = FaultCode::kStopTooFar,
     .name = "stop too far",
     .text = "axis moved too far in a stop",
     .meaning = "An axis that is being stopped has moved farther than its stopping distance."},
    {.code = FaultCode::kBrakesSlip,
     .name = "brake slips",
     .text = "axis moves with its brake closed",
     .meaning =
         "An axis moves although its drive is off and its brake closed, or its encoders say so."},
    {.code = FaultCode::kLimitNotHeld,
     .name = "limit not held",
     .text = "the motors cannot stop the device at a limit",
     .meaning = "The hand moves the device towards or past a limit, and its motors cannot stop it "
                "there, so that the brakes do."},
};

constexpr FaultWords kUnknown = {
    .name = "unknown", .text = "unknown fault", .meaning = "The cause is unknown to this program."};

constexpr bool is_ordered() noexcept {
  for (std::size_t i = 1; i < std::size(kFaults); ++i) {
    if (kFaults[i - 1].code >= kFaults[i].code) return false;
  }
  return true;
}
static_assert(is_ordered(), "one row per fault, in the order of their numbers");

}  // namespace

const FaultWords& fault_words(FaultCode code) noexcept {
  for (const FaultWords& words : kFaults) {
    if (words.code == code) return words;
  }
  return kUnknown;
}

std::string_view to_string(FaultCode code) noexcept { return fault_words(code).text; }

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
