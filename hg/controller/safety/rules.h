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

/// One reason to stop. Its name and meaning are in fault_words(code), hg/signals/fault.h.
struct Rule {
  FaultCode code = FaultCode::kNone;
  std::string_view threshold;  ///< Key of device.yaml, or the threshold in words
  /// Share of the threshold from which a warning is given; 1 = no warning.
  double warn_from = 1.0;
  Debounce debounce;
  Stop reaction = Stop::kSto;  ///< Where a rule names none: it is the hardest
  std::string_view release;    ///< Condition for accepting a reset
};

inline constexpr Rule kRules[] = {
    {.code = FaultCode::kSensorNotFinite,
     .threshold = "any such value",
     .reaction = Stop::kSto,
     .release = "all sensors give numbers again"},
    {.code = FaultCode::kSequenceGap,
     .threshold = "sequence + 1",
     .reaction = Stop::kSto,
     .release = "samples follow each other again"},
    {.code = FaultCode::kEmergencyStop,
     .threshold = "input of the safety controller",
     .reaction = Stop::kSs1,
     .release = "the button is pulled out and the safety controller has been reset"},
    {.code = FaultCode::kDeviceSilent,
     .threshold = "50 ms (5 s in lock-step), docs/reference/device_protocol.md",
     .reaction = Stop::kSto,
     .release = "the run is started again"},
    {.code = FaultCode::kDeviceGone,
     .threshold = "its goodbye",
     .reaction = Stop::kSto,
     .release = "the run is started again"},
    {.code = FaultCode::kSensorFrozen,
     .threshold = "monitor.frozen_samples",
     .reaction = Stop::kSto,
     .release = "the sensor's values change again"},
    {.code = FaultCode::kSensorImplausible,
     .threshold = "monitor.plausibility_rad",
     .warn_from = 0.5,
     .debounce = {.samples = 3},
     .reaction = Stop::kSto,
     .release = "the sensors of the joint agree again"},
    {.code = FaultCode::kSensorJump,
     .threshold = "monitor.jump_factor",
     .reaction = Stop::kSto,
     .release = "positions no longer jump"},
    {.code = FaultCode::kClockWrong,
     .threshold = "monitor.clock_tolerance",
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "the clock advances by one period per sample again"},
    {.code = FaultCode::kBusErrors,
     .threshold = "0 answers missing",
     .warn_from = 0.0,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "all devices on the fieldbus answer again"},
    {.code = FaultCode::kWrenchTooLarge,
     .threshold = "monitor.force_max_N, monitor.torque_max_Nm",
     .warn_from = 0.55,
     .debounce = {.seconds = 0.005},
     .reaction = Stop::kSs2,
     .release = "the force on the handle is below the threshold"},
    {.code = FaultCode::kJointTorqueExceeded,
     .threshold = "monitor.torque_tolerance",
     .warn_from = 0.9,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "the joint torque is below the threshold"},
    {.code = FaultCode::kTooHot,
     .threshold = "monitor.temperature_max_C",
     .warn_from = 0.9,
     .debounce = {.seconds = 0.1},
     .reaction = Stop::kSs1,
     .release = "the motor has cooled down"},
    {.code = FaultCode::kDriveFault,
     .threshold = "its status",
     .reaction = Stop::kSto,
     .release = "the fault of the drive is cleared"},
    {.code = FaultCode::kMotorDeviates,
     .threshold = "monitor.motor_tolerance",
     .warn_from = 0.6,
     .debounce = {.seconds = 0.05},
     .reaction = Stop::kSto,
     .release = "at once, and look at motor and drive"},
    {.code = FaultCode::kTorqueUnexplained,
     .threshold = "monitor.unexplained_tolerance",
     .warn_from = 0.6,
     .debounce = {.seconds = 0.02},
     .reaction = Stop::kSs1,
     .release = "at once; check what touches the arm, and tare the force sensor"},
    {.code = FaultCode::kTurnUnexplained,
     .threshold = "monitor.gyroscope_tolerance_rad",
     .warn_from = 0.6,
     .debounce = {.samples = 3},
     .reaction = Stop::kSto,
     .release =
         "at once, and look at encoders and gyroscope: the joints may not be where they seem"},
    {.code = FaultCode::kMotionUnexplained,
     .threshold = "monitor.accelerometer_tolerance_m_per_s",
     .warn_from = 0.6,
     .debounce = {.samples = 5},
     .reaction = Stop::kSto,
     .release = "at once, and look at couplings, encoders and accelerometer: the device may not be "
                "where it seems"},
    {.code = FaultCode::kSensorIncomplete,
     .threshold = "values per joint or axis",
     .reaction = Stop::kSto,
     .release = "samples are complete again; a driver is at fault"},
    {.code = FaultCode::kCommandsLost,
     .threshold = "10 ms, 5 ms where the device deviates from commands; torque loop 50 ms in sum",
     .reaction = Stop::kSto,
     .release = "at once, or with the run where the device has ended it; look at the connection, "
                "and at what else this computer does"},
    {.code = FaultCode::kOperatorReleased,
     .threshold = "input of the safety controller",
     .reaction = Stop::kSs1,
     .release = "the operator holds the switch and arms again; no reset is needed"},
    {.code = FaultCode::kScannerField,
     .threshold = "input of the safety controller",
     .reaction = Stop::kSs1,
     .release = "the field is clear and the safety controller has been reset"},
    {.code = FaultCode::kSafetyInputsDisagree,
     .threshold = "discrepancy time of the safety controller",
     .reaction = Stop::kSs1,
     .release = "both channels agree and the safety controller has been reset"},
    {.code = FaultCode::kSafeSpeedExceeded,
     .threshold = "monitor.safe_speed_m_per_s",
     .warn_from = 0.95,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "at once; it is armed again once it stands still"},
    {.code = FaultCode::kTwinForceWrong,
     .threshold = "monitor.force_max_N, monitor.torque_max_Nm; both for joints, at 1 m",
     .reaction = Stop::kSs2,
     .release = "the remote machine gives usable forces again"},
    {.code = FaultCode::kSolverFailed,
     .threshold = "status of the solver",
     .reaction = Stop::kSs2,
     .release = "at once; the cause is in the problem that the run has kept"},
    {.code = FaultCode::kReferenceNotFinite,
     .threshold = "any such value",
     .reaction = Stop::kSs2,
     .release = "at once"},
    {.code = FaultCode::kCommandNotFinite,
     .threshold = "any such value",
     .reaction = Stop::kSto,
     .release = "at once; estimation and control are reset"},
    {.code = FaultCode::kCycleOverrun,
     .threshold = "monitor.overruns_in_a_row, monitor.overruns_per_s",
     .reaction = Stop::kSs2,
     .release = "at once; look at what else this computer does"},
    {.code = FaultCode::kLimitExceeded,
     .threshold = "monitor.position_tolerance_rad, monitor.position_tolerance_m, "
                  "monitor.virtual_tolerance_rad, monitor.cartesian_tolerance_m",
     .warn_from = 0.3,
     .reaction = Stop::kSs1,
     .release = "at once; from where it stands it may only move back inside"},
    {.code = FaultCode::kSpeedExceeded,
     .threshold = "monitor.speed_tolerance",
     .warn_from = 0.95,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "at once; it is armed again once it stands still"},
    {.code = FaultCode::kTrackingLost,
     .threshold = "monitor.tracking_tolerance_rad, monitor.tracking_tolerance_m",
     .warn_from = 0.375,
     .debounce = {.seconds = 0.02},
     .reaction = Stop::kSs2,
     .release = "at once; the reference begins at the device again"},
    {.code = FaultCode::kSyncLost,
     .threshold = "monitor.sync_tolerance_m",
     .warn_from = 0.5,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs2,
     .release = "at once; the twin begins at the handle again"},
    {.code = FaultCode::kLatencyGrew,
     .threshold = "half a period above the latency measured before arming",
     .debounce = {.seconds = 0.05},
     .reaction = Stop::kSto,
     .release = "at once; the latency is measured again before arming"},
    {.code = FaultCode::kCollisionAhead,
     .threshold = "collision.safe_distance_m",
     .reaction = Stop::kSs2,
     .release = "at once; from where it stands it may only move apart"},
    {.code = FaultCode::kGantryExceeded,
     .threshold = "monitor.gantry_tolerance_m, monitor.gantry_tolerance_rad, "
                  "monitor.speed_tolerance",
     .warn_from = 0.95,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "at once; from where it stands it may only move back inside"},
    {.code = FaultCode::kGantryDeviates,
     .threshold = "monitor.gantry_deviation_m_per_s, monitor.gantry_deviation_rad_per_s, "
                  "monitor.gantry_gap_m, monitor.gantry_gap_rad, monitor.gantry_drift_m, "
                  "monitor.gantry_drift_rad",
     .warn_from = 0.6,
     .debounce = {.seconds = 0.01},
     .reaction = Stop::kSto,
     .release = "at once; it is armed again once it stands still"},
    {.code = FaultCode::kOscillation,
     .threshold = "passivity.reaction: act",
     .reaction = Stop::kSs2,
     .release =
         "at once; hold the handle less stiffly, make the twin heavier or the surface softer"},
    {.code = FaultCode::kEnergy,
     .threshold = "observer of passivity",
     .reaction = Stop::kSs2,
     .release = "at once; the tank is reset"},
    {.code = FaultCode::kStopTooSlow,
     .threshold = "monitor.stop_time_s",
     .reaction = Stop::kSto,
     .release = "at once; find the cause: brakes had to stop it"},
    {.code = FaultCode::kAccelerationExceeded,
     .threshold = "monitor.acceleration_tolerance",
     .warn_from = 0.9,
     .debounce = {.samples = 3},
     .reaction = Stop::kSs1,
     .release = "at once; the reference begins at rest"},
    {.code = FaultCode::kBrakingPosition,
     .threshold = "monitor.braking_gap_rad, monitor.braking_gap_m, monitor.gantry_gap_m, "
                  "monitor.gantry_gap_rad",
     .warn_from = 0.6,
     .debounce = {.samples = 3},
     .release = "at once; find the cause: brakes had to stop it"},
    {.code = FaultCode::kBrakingSpeed,
     .threshold = "monitor.braking_deviation_rad_per_s, monitor.braking_deviation_m_per_s, "
                  "monitor.gantry_deviation_m_per_s, monitor.gantry_deviation_rad_per_s",
     .warn_from = 0.6,
     .debounce = {.seconds = 0.005},
     .release = "at once; find the cause: brakes had to stop it"},
    {.code = FaultCode::kStopTooFar,
     .threshold = "monitor.stop_distance_rad, monitor.stop_distance_m, "
                  "monitor.gantry_stop_distance_m, monitor.gantry_stop_distance_rad",
     .warn_from = 0.9,
     .release = "at once; find the cause: brakes had to stop it"},
    {.code = FaultCode::kBrakesSlip,
     .threshold = "monitor.brake_slip_rad, monitor.brake_slip_m",
     .debounce = {.samples = 3},
     .release = "the run is started again, after a start test: no software holds such an axis"},
    {.code = FaultCode::kLimitNotHeld,
     .threshold = "those of 300, of the place that it will have in 0.1 s",
     .debounce = {.seconds = 0.005},
     .release = "at once; push less, or keep farther from the limit"},
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
