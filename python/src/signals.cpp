/// The structs that travel, and the numbers that stand for words in them.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <string>
#include <type_traits>

#include "hg/signals/limit.h"
#include "python/src/bind.h"
#include "python/src/fields.h"

namespace hg::python {
namespace {

void bind_modes(nb::module_& module) {
  nb::enum_<Mode>(module, "Mode", nb::is_arithmetic(), "Operating state.")
      .value("OFF", Mode::kOff)
      .value("READY", Mode::kReady)
      .value("ARMED", Mode::kArmed)
      .value("RUNNING", Mode::kRunning)
      .value("STOPPING", Mode::kStopping)
      .value("FAULT", Mode::kFault);
  nb::enum_<ModeRequest>(module, "ModeRequest", nb::is_arithmetic(), "What an operator asks for.")
      .value("NONE", ModeRequest::kNone)
      .value("ARM", ModeRequest::kArm)
      .value("RUN", ModeRequest::kRun)
      .value("STOP", ModeRequest::kStop)
      .value("RESET", ModeRequest::kReset)
      .value("TARE", ModeRequest::kTare)
      .value("AUTONOMOUS", ModeRequest::kAutonomous);
  nb::enum_<Stop>(module, "Stop", nb::is_arithmetic(), "How the device is being stopped.")
      .value("NONE", Stop::kNone)
      .value("SS2", Stop::kSs2)
      .value("SS1", Stop::kSs1)
      .value("STO", Stop::kSto);
  nb::enum_<TareStatus>(module, "TareStatus", nb::is_arithmetic(), "How the last tare went.")
      .value("NONE", TareStatus::kNone)
      .value("UNDER_WAY", TareStatus::kUnderWay)
      .value("DONE", TareStatus::kDone)
      .value("REFUSED_HELD", TareStatus::kRefusedHeld)
      .value("REFUSED_MOVING", TareStatus::kRefusedMoving)
      .value("REFUSED_UNSTEADY", TareStatus::kRefusedUnsteady)
      .value("REFUSED_RUNNING", TareStatus::kRefusedRunning);
  nb::enum_<Refusal>(module, "Refusal", nb::is_arithmetic(), "Why a request was not followed.")
      .value("NONE", Refusal::kNone)
      .value("NOT_TARED", Refusal::kNotTared)
      .value("LATENCY_TOO_LONG", Refusal::kLatencyTooLong)
      .value("LATENCY_UNKNOWN", Refusal::kLatencyUnknown)
      .value("NOT_READY", Refusal::kNotReady)
      .value("NOT_ARMED", Refusal::kNotArmed)
      .value("FAULT_PRESENT", Refusal::kFaultPresent)
      .value("CAUSE_REMAINS", Refusal::kCauseRemains)
      .value("NO_FAULT", Refusal::kNoFault)
      .value("OPERATOR_RELEASED", Refusal::kOperatorReleased)
      .value("NOBODY_HOLDS", Refusal::kNobodyHolds)
      .value("SOMEBODY_HOLDS", Refusal::kSomebodyHolds)
      .value("NO_OVERRIDE", Refusal::kNoOverride)
      .value("FIELD_OCCUPIED", Refusal::kFieldOccupied);
  nb::enum_<SolverStatus>(module, "SolverStatus", nb::is_arithmetic())
      .value("NOT_RUN", SolverStatus::kNotRun)
      .value("SOLVED", SolverStatus::kSolved)
      .value("BUDGET_SPENT", SolverStatus::kBudgetSpent,
             "ended before it was proven; the joints keep their limits")
      .value("FAILED", SolverStatus::kFailed);
}

void bind_fault_codes(nb::module_& module) {
  nb::enum_<FaultCode> codes(module, "FaultCode", nb::is_arithmetic(), "Why the device stopped.");
  codes.value("NONE", FaultCode::kNone)
      .value("SENSOR_NOT_FINITE", FaultCode::kSensorNotFinite)
      .value("SEQUENCE_GAP", FaultCode::kSequenceGap)
      .value("EMERGENCY_STOP", FaultCode::kEmergencyStop)
      .value("DEVICE_SILENT", FaultCode::kDeviceSilent)
      .value("DEVICE_GONE", FaultCode::kDeviceGone)
      .value("SENSOR_FROZEN", FaultCode::kSensorFrozen)
      .value("SENSOR_IMPLAUSIBLE", FaultCode::kSensorImplausible)
      .value("SENSOR_JUMP", FaultCode::kSensorJump)
      .value("CLOCK_WRONG", FaultCode::kClockWrong)
      .value("BUS_ERRORS", FaultCode::kBusErrors)
      .value("WRENCH_TOO_LARGE", FaultCode::kWrenchTooLarge)
      .value("JOINT_TORQUE_EXCEEDED", FaultCode::kJointTorqueExceeded)
      .value("TOO_HOT", FaultCode::kTooHot)
      .value("DRIVE_FAULT", FaultCode::kDriveFault)
      .value("MOTOR_DEVIATES", FaultCode::kMotorDeviates)
      .value("TORQUE_UNEXPLAINED", FaultCode::kTorqueUnexplained)
      .value("COMMANDS_LOST", FaultCode::kCommandsLost)
      .value("OPERATOR_RELEASED", FaultCode::kOperatorReleased)
      .value("SCANNER_FIELD", FaultCode::kScannerField)
      .value("SAFETY_INPUTS_DISAGREE", FaultCode::kSafetyInputsDisagree)
      .value("SAFE_SPEED_EXCEEDED", FaultCode::kSafeSpeedExceeded)
      .value("SOLVER_FAILED", FaultCode::kSolverFailed)
      .value("REFERENCE_NOT_FINITE", FaultCode::kReferenceNotFinite)
      .value("COMMAND_NOT_FINITE", FaultCode::kCommandNotFinite)
      .value("CYCLE_OVERRUN", FaultCode::kCycleOverrun)
      .value("LIMIT_EXCEEDED", FaultCode::kLimitExceeded)
      .value("SPEED_EXCEEDED", FaultCode::kSpeedExceeded)
      .value("TRACKING_LOST", FaultCode::kTrackingLost)
      .value("SYNC_LOST", FaultCode::kSyncLost)
      .value("LATENCY_GREW", FaultCode::kLatencyGrew)
      .value("COLLISION_AHEAD", FaultCode::kCollisionAhead)
      .value("GANTRY_EXCEEDED", FaultCode::kGantryExceeded)
      .value("GANTRY_DEVIATES", FaultCode::kGantryDeviates)
      .value("OSCILLATION", FaultCode::kOscillation)
      .value("ENERGY", FaultCode::kEnergy)
      .value("STOP_TOO_SLOW", FaultCode::kStopTooSlow)
      .value("ACCELERATION_EXCEEDED", FaultCode::kAccelerationExceeded)
      .value("TURN_UNEXPLAINED", FaultCode::kTurnUnexplained)
      .value("MOTION_UNEXPLAINED", FaultCode::kMotionUnexplained)
      .value("BRAKING_POSITION", FaultCode::kBrakingPosition)
      .value("BRAKING_SPEED", FaultCode::kBrakingSpeed)
      .value("STOP_TOO_FAR", FaultCode::kStopTooFar)
      .value("BRAKES_SLIP", FaultCode::kBrakesSlip);
}

void bind_limit_words(nb::module_& module) {
  nb::enum_<LimitState>(module, "LimitState", nb::is_arithmetic(), "Side on which a limit acts.")
      .value("INACTIVE", LimitState::kInactive)
      .value("LOWER", LimitState::kLower)
      .value("UPPER", LimitState::kUpper)
      .value("VIOLATED", LimitState::kViolated);
  nb::enum_<LimitCause>(module, "LimitCause", nb::is_arithmetic(), "Which rating of it acts.")
      .value("NONE", LimitCause::kNone)
      .value("POSITION", LimitCause::kPosition)
      .value("VELOCITY", LimitCause::kVelocity)
      .value("ACCELERATION", LimitCause::kAcceleration)
      .value("LOCK", LimitCause::kLock)
      .value("LATCH", LimitCause::kLatch)
      .value("FRICTION", LimitCause::kFriction);
  nb::class_<LimitInfo>(module, "LimitInfo", "One limited quantity of device or twin.")
      .def_ro("name", &LimitInfo::name)
      .def_ro("is_angle", &LimitInfo::is_angle, "rad and Nm, otherwise m and N")
      .def_prop_ro("lower", [](const LimitInfo& limit) { return limit.range.lb; })
      .def_prop_ro("upper", [](const LimitInfo& limit) { return limit.range.ub; });
}

void bind_parameters(nb::module_& module) {
  nb::enum_<Parameter>(module, "Parameter", nb::is_arithmetic(),
                       "What of a twin may change while it runs.")
      .value("NONE", Parameter::kNone)
      .value("STIFFNESS", Parameter::kStiffness)
      .value("REST", Parameter::kRest)
      .value("PRELOAD", Parameter::kPreload)
      .value("DAMPING", Parameter::kDamping)
      .value("QUADRATIC_DAMPING", Parameter::kQuadraticDamping)
      .value("FRICTION", Parameter::kFriction)
      .value("LOWER_LIMIT", Parameter::kLowerLimit)
      .value("UPPER_LIMIT", Parameter::kUpperLimit)
      .value("SPEED_LIMIT", Parameter::kSpeedLimit)
      .value("REFERENCE_WRENCH", Parameter::kReferenceWrench)
      .value("GRAVITY", Parameter::kGravity)
      .value("MASS_SCALE", Parameter::kMassScale);
  nb::enum_<ChangeStatus>(module, "ChangeStatus", nb::is_arithmetic(),
                          "What became of the change of a parameter.")
      .value("NONE", ChangeStatus::kNone)
      .value("TAKEN", ChangeStatus::kTaken)
      .value("REFUSED", ChangeStatus::kRefused);
}

}  // namespace

void bind_signals(nb::module_& module) {
  bind_modes(module);
  bind_fault_codes(module);
  bind_limit_words(module);
  bind_parameters(module);

  bind_fields<Pose>(module, "Pose", "Pose of a frame relative to another.")
      .def(
          "__init__",
          [](Pose* self, const ArrayIn& p, const ArrayIn& r) {
            new (self) Pose;
            assign(p, "p", self->p);
            assign(r, "r", self->R);
          },
          nb::arg("p"), nb::arg("r"), "Position (3, m) and rotation matrix (3, 3).")
      .def("__matmul__", [](const Pose& a, const Pose& b) { return a * b; })
      .def("inverse", [](const Pose& pose) { return inverse(pose); });
  bind_fields<SafetyInputs>(module, "SafetyInputs", "What the safety controller says.");
  bind_fields<SafetyPanel>(module, "SafetyPanel", "Buttons and keys of a simulated operator.");
  bind_fields<HandTarget>(module, "HandTarget", "Where a simulated person wants the handle.");
  bind_fields<ParameterChange>(module, "ParameterChange", "A parameter of the twin and its value.");
  bind_fields<SensorFrame>(module, "SensorFrame", "What a device measured in one sample.");
  bind_fields<OperatorFrame>(module, "OperatorFrame", "What else enters a cycle from outside.");
  bind_fields<CommandFrame>(module, "CommandFrame", "What the device is asked to do.");
  bind_fields<Fault>(module, "Fault", "What stopped the device.");
  bind_fields<RobotState>(module, "RobotState", "What estimation knows about the device.");
  bind_fields<InertialReport>(module, "InertialReport", "What inertial units on links say.");
  bind_fields<ReferenceState>(module, "ReferenceState", "Reference of the manipulator.");
  bind_fields<TwinState>(module, "TwinState", "State of the twin.");
  bind_fields<TrackingReport>(module, "TrackingReport", "How well the device follows.");
  bind_fields<BystanderReport>(module, "BystanderReport", "What a simulated bystander bears.");
  bind_fields<Truth>(module, "Truth", "What is really the case; only a simulation knows.");
  bind_fields<Budget>(module, "Budget", "Where the user's wrench goes.");
  bind_fields<LimitReport>(module, "LimitReport", "One limit in one cycle.");
  bind_fields<CollisionReport>(module, "CollisionReport", "How near the device comes to itself.");
  bind_fields<PassivityReport>(module, "PassivityReport", "Energy and oscillation at the handle.");
  bind_fields<ContactReport>(module, "ContactReport", "What virtual surfaces do to the twin.");
  bind_fields<TouchReport>(module, "TouchReport", "What touches the arm beside the handle.");
  bind_fields<CycleRecord>(module, "CycleRecord", "Everything that a cycle has to say.");
}

}  // namespace hg::python
