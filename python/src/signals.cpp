/// Bindings of the exchanged structs, and of the enumerations in them.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <string>
#include <type_traits>

#include "hg/signals/limit.h"
#include "python/src/bind.h"
#include "python/src/bind_enum.h"
#include "python/src/fields.h"

namespace hg::python {
namespace {

void bind_enums(nb::module_& module) {
  bind_enum<Mode>(module, "Mode", "Operating state.");
  bind_enum<ModeRequest>(module, "ModeRequest", "What an operator asks for.");
  bind_enum<Stop>(module, "Stop", "How the device is being stopped.");
  bind_enum<TareStatus>(module, "TareStatus", "How the last tare went.");
  bind_enum<Refusal>(module, "Refusal", "Why a request was not followed.");
  bind_enum<SolverStatus>(module, "SolverStatus", "How the solver ended.");
  bind_enum<FaultCode, 512>(module, "FaultCode", "Why the device stopped.");
  bind_enum<LimitState>(module, "LimitState", "Side on which a limit acts.");
  bind_enum<LimitCause>(module, "LimitCause", "Which rating of it acts.");
  bind_enum<Parameter>(module, "Parameter", "What of a twin may change while it runs.");
  bind_enum<ChangeStatus>(module, "ChangeStatus", "What became of the change of a parameter.");
}

void bind_limit_info(nb::module_& module) {
  nb::class_<LimitInfo>(module, "LimitInfo", "One limited quantity of device or twin.")
      .def_ro("name", &LimitInfo::name)
      .def_ro("is_angle", &LimitInfo::is_angle, "rad and Nm, otherwise m and N")
      .def_prop_ro("lower", [](const LimitInfo& limit) { return limit.range.lb; })
      .def_prop_ro("upper", [](const LimitInfo& limit) { return limit.range.ub; });
}

}  // namespace

void bind_signals(nb::module_& module) {
  bind_enums(module);
  bind_limit_info(module);

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
