/// Rules that stop the device, as data: source of the table in docs/concepts/safety.md, of the
/// explanations of program and page, and of the reactions of supervisor and monitor.
///
/// Source: [HANDBOOK] 6.2, 6.5; where a number differs, docs/concepts/safety.md says why. Not a
/// certified safety function.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "hg/signals/state.h"

namespace hg::safety {

/// Time a rule must be broken without interruption before it acts: until both have passed.
struct Debounce {
  int samples = 1;
  double seconds = 0.0;
};

/// One reason to stop.
struct Rule {
  FaultCode code = FaultCode::kNone;
  std::string_view name;       ///< Name in two or three words
  std::string_view meaning;    ///< Meaning in one sentence
  std::string_view threshold;  ///< Key of device.yaml, or the threshold in words
  /// Share of the threshold from which a warning is given; 1 = no warning.
  double warn_from = 1.0;
  Debounce debounce;
  Stop reaction = Stop::kSto;
  std::string_view release;  ///< Condition for accepting a reset
};

inline constexpr Rule kRules[] = {
    {.code = FaultCode::kSensorNotFinite,
     .name = "sensor not finite",
     .meaning = "A sensor gives a value that is not a number or infinite.",
     .threshold = "any such value",
     .reaction = Stop::kSto,
     .release = "all sensors give numbers again"},
    {.code = FaultCode::kSequenceGap,
     .name = "sequence gap",
     .meaning = "The device skipped a sample or repeated one.",
     .threshold = "sequence + 1",
     .reaction = Stop::kSto,
     .release = "samples follow each other again"},
    {.code = FaultCode::kEmergencyStop,
     .name = "emergency stop",
     .meaning = "A stop button is pressed, or the safety controller has tripped.",
     .threshold = "input of the safety controller",
     .reaction = Stop::kSs1,
     .release = "the button is pulled out and the safety controller has been reset"},
    {.code = FaultCode::kDeviceSilent,
     .name = "device silent",
     .meaning = "A remote device was silent for too long.",
     .threshold = "50 ms (5 s in lock-step), docs/reference/device_protocol.md",
     .reaction = Stop::kSto,
     .release = "the run is started again"},
    {.code = FaultCode::kDeviceGone,
     .name = "device gone",
     .meaning = "A remote device has ended the session.",
     .threshold = "its goodbye",
     .reaction = Stop::kSto,
     .release = "the run is started again"},
    {.code = FaultCode::kSensorFrozen,
     .name = "sensor frozen",
     .meaning = "A sensor with noise shows the same bits again and again.",
     .threshold = "monitor.frozen_samples",
     .reaction = Stop::kSto,
     .release = "the sensor's values change again"},
    {.code = FaultCode::kSensorImplausible,
     .name = "sensors contradict",
     .meaning = "Motor encoder, joint torque sensor and link encoder of a joint do not fit "
                "together.",
     .threshold = "monitor.plausibility_rad",
     .warn_from = 0.5,
     .debounce = {.samples = 3},
     .reaction = Stop::kSto,
     .release = "the sensors of the joint agree again"},
    {.code = FaultCode::kSensorJump,
     .name = "position jump",
     .meaning = "A measured position moved farther in one sample than the joint can.",
     .threshold = "monitor.jump_factor",
     .reaction = Stop::kSto,
     .release = "positions no longer jump"},
    {.code = FaultCode::kClockWrong,
     .name = "clock wrong",
     .meaning = "The device's clock does not keep step with its samples.",
     .threshold = "monitor.clock_tolerance",
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "the clock advances by one period per sample again"},
    {.code = FaultCode::kBusErrors,
     .name = "fieldbus answers missing",
     .meaning = "Devices on the fieldbus did not answer in samples that follow each other.",
     .threshold = "0 answers missing",
     .warn_from = 0.0,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "all devices on the fieldbus answer again"},
    {.code = FaultCode::kWrenchTooLarge,
     .name = "user wrench",
     .meaning = "The user pulls or turns harder than the sensor and the person should bear.",
     .threshold = "monitor.force_max_N, monitor.torque_max_Nm",
     .warn_from = 0.55,
     .debounce = {.seconds = 0.005},
     .reaction = Stop::kSs2,
     .release = "the force on the handle is below the threshold"},
    {.code = FaultCode::kJointTorqueExceeded,
     .name = "joint torque",
     .meaning = "A joint carries more than the peak torque of its actuator.",
     .threshold = "monitor.torque_tolerance",
     .warn_from = 0.9,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "the joint torque is below the threshold"},
    {.code = FaultCode::kTooHot,
     .name = "motor too hot",
     .meaning = "A motor is hotter than allowed.",
     .threshold = "monitor.temperature_max_C",
     .warn_from = 0.9,
     .debounce = {.seconds = 0.1},
     .reaction = Stop::kSs1,
     .release = "the motor has cooled down"},
    {.code = FaultCode::kDriveFault,
     .name = "drive fault",
     .meaning = "A drive reports a fault.",
     .threshold = "its status",
     .reaction = Stop::kSto,
     .release = "the fault of the drive is cleared"},
    {.code = FaultCode::kMotorDeviates,
     .name = "motor torque",
     .meaning = "A motor does not give the commanded torque.",
     .threshold = "monitor.motor_tolerance",
     .warn_from = 0.6,
     .debounce = {.seconds = 0.05},
     .reaction = Stop::kSto,
     .release = "at once, and look at motor and drive"},
    {.code = FaultCode::kTorqueUnexplained,
     .name = "unexplained torque",
     .meaning = "Something but the hand at the handle pushes the arm, or force sensor and joint "
                "torques contradict each other.",
     .threshold = "monitor.unexplained_tolerance",
     .warn_from = 0.6,
     .debounce = {.seconds = 0.02},
     .reaction = Stop::kSs1,
     .release = "at once; check what touches the arm, and tare the force sensor"},
    {.code = FaultCode::kTurnUnexplained,
     .name = "gyroscope contradicts",
     .meaning =
         "The handle turns otherwise than the encoders of the joints say: an encoder drifts, "
         "or the gyroscope does.",
     .threshold = "monitor.gyroscope_tolerance_rad",
     .warn_from = 0.6,
     .debounce = {.samples = 3},
     .reaction = Stop::kSto,
     .release =
         "at once, and look at encoders and gyroscope: the joints may not be where they seem"},
    {.code = FaultCode::kMotionUnexplained,
     .name = "accelerometer contradicts",
     .meaning =
         "The handle gets faster than the encoders of gantry and joints say: a coupling or belt "
         "slips, encoders drift, or the accelerometer is wrong.",
     .threshold = "monitor.accelerometer_tolerance_m_per_s",
     .warn_from = 0.6,
     .debounce = {.samples = 5},
     .reaction = Stop::kSto,
     .release = "at once, and look at couplings, encoders and accelerometer: the device may not be "
                "where it seems"},
    {.code = FaultCode::kCommandsLost,
     .name = "commands lost",
     .meaning =
         "No new command has reached the device for too long: lost or held up on the way, or "
         "this computer was late.",
     .threshold = "50 ms; 5 ms once the device does not move as commanded",
     .reaction = Stop::kSto,
     .release = "at once, or with the run where the device has ended it; look at the connection, "
                "and at what else this computer does"},
    {.code = FaultCode::kOperatorReleased,
     .name = "operator let go",
     .meaning = "The operator let go of the enabling switch, or squeezed it through.",
     .threshold = "input of the safety controller",
     .reaction = Stop::kSs1,
     .release = "the operator holds the switch and arms again; no reset is needed"},
    {.code = FaultCode::kScannerField,
     .name = "scanner field",
     .meaning = "A person is in the scanner's field while the handle is not held.",
     .threshold = "input of the safety controller",
     .reaction = Stop::kSs1,
     .release = "the field is clear and the safety controller has been reset"},
    {.code = FaultCode::kSafetyInputsDisagree,
     .name = "safety inputs disagree",
     .meaning = "The two channels of a safety input differed for too long.",
     .threshold = "discrepancy time of the safety controller",
     .reaction = Stop::kSs1,
     .release = "both channels agree and the safety controller has been reset"},
    {.code = FaultCode::kSafeSpeedExceeded,
     .name = "safe speed",
     .meaning =
         "While the handle was not held, the device was faster than the safely limited speed.",
     .threshold = "monitor.safe_speed_m_per_s",
     .warn_from = 0.95,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "at once; it is armed again once it stands still"},
    {.code = FaultCode::kSolverFailed,
     .name = "solver failed",
     .meaning = "The rendering problem of a cycle was not solved.",
     .threshold = "status of the solver",
     .reaction = Stop::kSs2,
     .release = "at once; the cause is in the problem that the run has kept"},
    {.code = FaultCode::kReferenceNotFinite,
     .name = "reference not finite",
     .meaning = "The rendering gave a value that is not a number or infinite.",
     .threshold = "any such value",
     .reaction = Stop::kSs2,
     .release = "at once"},
    {.code = FaultCode::kCommandNotFinite,
     .name = "command not finite",
     .meaning = "The control gave a value that is not a number or infinite.",
     .threshold = "any such value",
     .reaction = Stop::kSto,
     .release = "at once; estimation and control are reset"},
    {.code = FaultCode::kCycleOverrun,
     .name = "cycles late",
     .meaning = "Cycles of the loop came too late too often.",
     .threshold = "monitor.overruns_in_a_row, monitor.overruns_per_s",
     .reaction = Stop::kSs2,
     .release = "at once; look at what else this computer does"},
    {.code = FaultCode::kLimitExceeded,
     .name = "position limit",
     .meaning = "A joint, a sum of joints or a frame is outside its limit by more than the "
                "tolerance.",
     .threshold = "monitor.position_tolerance_rad, monitor.position_tolerance_m, "
                  "monitor.virtual_tolerance_rad, monitor.cartesian_tolerance_m",
     .warn_from = 0.3,
     .reaction = Stop::kSs1,
     .release = "at once; from where it stands it may only move back inside"},
    {.code = FaultCode::kSpeedExceeded,
     .name = "joint speed",
     .meaning = "A joint is faster than its rating allows.",
     .threshold = "monitor.speed_tolerance",
     .warn_from = 0.95,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "at once; it is armed again once it stands still"},
    {.code = FaultCode::kTrackingLost,
     .name = "tracking",
     .meaning = "A joint is too far from its reference.",
     .threshold = "monitor.tracking_tolerance_rad, monitor.tracking_tolerance_m",
     .warn_from = 0.375,
     .debounce = {.seconds = 0.02},
     .reaction = Stop::kSs2,
     .release = "at once; the reference begins at the device again"},
    {.code = FaultCode::kSyncLost,
     .name = "handle and twin apart",
     .meaning = "Handle and twin are too far apart.",
     .threshold = "monitor.sync_tolerance_m",
     .warn_from = 0.5,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs2,
     .release = "at once; the twin begins at the handle again"},
    {.code = FaultCode::kLatencyGrew,
     .name = "latency grew",
     .meaning = "Commands reach the drives later than the torque loop can bear.",
     .threshold = "half a period above the latency measured before arming",
     .debounce = {.seconds = 0.05},
     .reaction = Stop::kSto,
     .release = "at once; the latency is measured again before arming"},
    {.code = FaultCode::kCollisionAhead,
     .name = "collision ahead",
     .meaning = "The device would hit itself or its surroundings if it braked any later.",
     .threshold = "collision.safe_distance_m",
     .reaction = Stop::kSs2,
     .release = "at once; from where it stands it may only move apart"},
    {.code = FaultCode::kGantryExceeded,
     .name = "gantry range or speed",
     .meaning = "An axis of the gantry is beyond its range or faster than its drive may be.",
     .threshold = "monitor.gantry_tolerance_m, monitor.gantry_tolerance_rad, "
                  "monitor.speed_tolerance",
     .warn_from = 0.95,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "at once; from where it stands it may only move back inside"},
    {.code = FaultCode::kGantryDeviates,
     .name = "gantry deviates",
     .meaning = "An axis of the gantry does not move as commanded.",
     .threshold = "monitor.gantry_deviation_m_per_s, monitor.gantry_deviation_rad_per_s, "
                  "monitor.gantry_gap_m, monitor.gantry_gap_rad, monitor.gantry_drift_m, "
                  "monitor.gantry_drift_rad",
     .warn_from = 0.6,
     .debounce = {.seconds = 0.01},
     .reaction = Stop::kSto,
     .release = "at once; it is armed again once it stands still"},
    {.code = FaultCode::kOscillation,
     .name = "oscillation",
     .meaning = "Hand and device shake each other, or a body bounces off a surface and drives the "
                "hand, and it does not end.",
     .threshold = "passivity.reaction: act",
     .reaction = Stop::kSs2,
     .release =
         "at once; hold the handle less stiffly, make the twin heavier or the surface softer"},
    {.code = FaultCode::kEnergy,
     .name = "energy",
     .meaning = "The device has given more energy than its tank holds.",
     .threshold = "observer of passivity",
     .reaction = Stop::kSs2,
     .release = "at once; the tank is reset"},
    {.code = FaultCode::kStopTooSlow,
     .name = "stop too slow",
     .meaning = "A controlled stop did not come to rest in time.",
     .threshold = "monitor.stop_time_s",
     .reaction = Stop::kSto,
     .release = "at once; find the cause: brakes had to stop it"},
    {.code = FaultCode::kAccelerationExceeded,
     .name = "joint acceleration",
     .meaning = "The reference of a joint accelerates more than its rating allows.",
     .threshold = "monitor.acceleration_tolerance",
     .warn_from = 0.9,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "at once; the reference begins at rest"},
    {.code = FaultCode::kBrakingPosition,
     .name = "off the braking ramp",
     .meaning = "An axis that is being stopped is not where its braking ramp takes it.",
     .threshold = "monitor.braking_gap_rad, monitor.braking_gap_m, monitor.gantry_gap_m, "
                  "monitor.gantry_gap_rad",
     .warn_from = 0.6,
     .debounce = {.samples = 3},
     .reaction = Stop::kSto,
     .release = "at once; find the cause: brakes had to stop it"},
    {.code = FaultCode::kBrakingSpeed,
     .name = "brakes too slowly",
     .meaning = "An axis that is being stopped does not have the speed of its braking ramp.",
     .threshold = "monitor.braking_deviation_rad_per_s, monitor.braking_deviation_m_per_s, "
                  "monitor.gantry_deviation_m_per_s, monitor.gantry_deviation_rad_per_s",
     .warn_from = 0.6,
     .debounce = {.seconds = 0.005},
     .reaction = Stop::kSto,
     .release = "at once; find the cause: brakes had to stop it"},
    {.code = FaultCode::kStopTooFar,
     .name = "stop too far",
     .meaning = "An axis that is being stopped has moved farther than its stopping distance.",
     .threshold = "monitor.stop_distance_rad, monitor.stop_distance_m, "
                  "monitor.gantry_stop_distance_m, monitor.gantry_stop_distance_rad",
     .warn_from = 0.9,
     .reaction = Stop::kSto,
     .release = "at once; find the cause: brakes had to stop it"},
    {.code = FaultCode::kBrakesSlip,
     .name = "brake slips",
     .meaning = "An axis moves although its drive is off and its brake closed, or its encoders "
                "say so.",
     .threshold = "monitor.brake_slip_rad, monitor.brake_slip_m",
     .debounce = {.samples = 3},
     .reaction = Stop::kSto,
     .release = "the run is started again, after a start test: no software holds such an axis"},
};

inline constexpr std::size_t kRuleCount = std::size(kRules);

/// Index of the rule of `code` in kRules; kRuleCount for kNone and unknown codes.
constexpr std::size_t rule_index(FaultCode code) noexcept {
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    if (kRules[i].code == code) return i;
  }
  return kRuleCount;
}

/// Rule of `code`; for an unknown code one that switches the drives off.
const Rule& rule_of(FaultCode code) noexcept;

/// Whether a cause counts as a fault. Releasing the enabling switch does not and needs no reset.
constexpr bool is_fault(FaultCode code) noexcept {
  return code != FaultCode::kNone && code != FaultCode::kOperatorReleased;
}

}  // namespace hg::safety
