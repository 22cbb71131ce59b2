/// Bindings of the exchanged structs, and of the enumerations in them.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hg/config/schema.h"
#include "hg/signals/limit.h"
#include "hg/signals/state.h"
#include "hg/signals/twin_parameter.h"
#include "python/src/bind.h"
#include "python/src/bind_enum.h"
#include "python/src/fields.h"

namespace hg::python {
namespace {

void bind_enums(nb::module_& module) {
  bind_enum<Mode>(module, "Mode", "Operating state.");
  bind_enum<ModeRequest>(module, "ModeRequest", "Request of an operator.");
  bind_enum<Stop>(module, "Stop", "Kind of a stop.");
  bind_enum<TareStatus>(module, "TareStatus", "Outcome of the last tare.");
  bind_enum<Refusal>(module, "Refusal", "Reason for refusing a request.");
  bind_enum<SolverStatus>(module, "SolverStatus", "Outcome of the solver.");
  bind_enum<FaultCode, 512>(module, "FaultCode", "Cause of a stop.");
  bind_enum<LimitState>(module, "LimitState", "Active side of a limit.");
  bind_enum<LimitCause>(module, "LimitCause", "Active rating of a limit.");
  bind_enum<Parameter>(module, "Parameter", "Parameter of a twin that may change at run time.");
  bind_enum<RemoteLink>(module, "RemoteLink", "State of the link to a remote machine.");
  bind_enum<RemoteCause>(module, "RemoteCause", "Why a remote machine does not follow.");
  bind_enum<ChangeStatus>(module, "ChangeStatus", "Outcome of a parameter change.");
}

void bind_limit_info(nb::module_& module) {
  nb::class_<LimitInfo>(module, "LimitInfo", "One limited quantity of device or twin.")
      .def_ro("name", &LimitInfo::name)
      .def_ro("is_angle", &LimitInfo::is_angle, "rad and Nm, otherwise m and N")
      .def_prop_ro("lower", [](const LimitInfo& limit) { return limit.range.lb; })
      .def_prop_ro("upper", [](const LimitInfo& limit) { return limit.range.ub; });
}

std::string text(std::string_view view) { return std::string(view); }

void bind_twin_parameters(nb::module_& module) {
  using Facts = ParameterFacts;
  nb::class_<Facts>(module, "TwinParameter", "Facts about a parameter that may change at run time.")
      .def_ro("parameter", &Facts::parameter)
      .def_prop_ro(
          "key", [](const Facts& facts) { return text(facts.key); },
          "Key in twin.yaml; of a joint, that of a revolute joint.")
      .def_prop_ro(
          "length_key", [](const Facts& facts) { return text(facts.length_key); },
          "Key of a prismatic joint; empty where there is no other.")
      .def_prop_ro("unit", [](const Facts& facts) { return text(config::unit_of(facts.key)); })
      .def_prop_ro("length_unit",
                   [](const Facts& facts) { return text(config::unit_of(facts.length_key)); })
      .def_prop_ro("label", [](const Facts& facts) { return text(facts.label); })
      .def_prop_ro("help", [](const Facts& facts) { return text(facts.help); })
      .def_prop_ro("lower", [](const Facts& facts) { return facts.range.lb; })
      .def_prop_ro("upper", [](const Facts& facts) { return facts.range.ub; })
      .def("allows", &allows, nb::arg("value"),
           "Whether a value is within the range, or an infinity that stands for no limit.");
  module.def(
      "twin_parameters", [] { return std::vector<Facts>(kParameters.begin(), kParameters.end()); },
      "The parameters of a twin that may change while it runs: names, units, ranges.");
}

}  // namespace

void bind_signals(nb::module_& module) {
  bind_enums(module);
  bind_limit_info(module);
  bind_twin_parameters(module);

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
  bind_fields<SafetyInputs>(module, "SafetyInputs", "Inputs of the safety controller.");
  bind_fields<SafetyPanel>(module, "SafetyPanel", "Buttons and keys of a simulated operator.");
  bind_fields<HandTarget>(module, "HandTarget", "Target of a simulated hand.");
  bind_fields<ParameterChange>(module, "ParameterChange", "New value of a parameter of the twin.");
  bind_fields<TwinForce>(module, "TwinForce", "Force of a remote machine on the twin.");
  bind_fields<TwinBase>(module, "TwinBase", "Motion of the place of the twin.");
  bind_fields<TeleoperationReport>(module, "TeleoperationReport", "Other side of a teleoperation.");
  bind_fields<SensorFrame>(module, "SensorFrame", "Sensor values of one sample.");
  bind_fields<OperatorFrame>(module, "OperatorFrame", "All inputs of a cycle besides sensors.");
  bind_fields<CommandFrame>(module, "CommandFrame", "Command to the device.");
  bind_fields<Fault>(module, "Fault", "Fault with the compared values.");
  bind_fields<RobotState>(module, "RobotState", "Estimated state of the device.");
  bind_fields<InertialReport>(module, "InertialReport", "Estimates from inertial units on links.");
  bind_fields<ReferenceState>(module, "ReferenceState", "Reference of the manipulator.");
  bind_fields<TwinState>(module, "TwinState", "State of the twin.");
  bind_fields<TrackingReport>(module, "TrackingReport", "Tracking of the reference by the device.");
  bind_fields<BystanderReport>(module, "BystanderReport", "Load on a simulated bystander.");
  bind_fields<WalkerReport>(module, "WalkerReport", "Body of a simulated person who walks.");
  bind_fields<Truth>(module, "Truth", "Ground truth of a simulation.");
  bind_fields<Budget>(module, "Budget", "Breakdown of the user's wrench.");
  bind_fields<LimitReport>(module, "LimitReport", "State of one limit in one cycle.");
  bind_fields<CollisionReport>(module, "CollisionReport",
                               "Distance to a collision if the device brakes now.");
  bind_fields<PassivityReport>(module, "PassivityReport", "Energy and oscillation at the handle.");
  bind_fields<ContactReport>(module, "ContactReport", "Contact of the twin with virtual surfaces.");
  bind_fields<TouchReport>(module, "TouchReport",
                           "Contact with the arm anywhere but at the handle.");
  bind_fields<RestReport>(module, "RestReport", "Drift of the force sensor's zero.");
  bind_fields<CycleRecord>(module, "CycleRecord", "All results of a cycle.");
}

}  // namespace hg::python
