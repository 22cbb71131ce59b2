/// Bindings of the simulated person of a scenario, for user-written simulators.
#include "hg/simulator/person/person.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <tuple>

#include "hg/scenario/assembly.h"
#include "python/src/arrays.h"
#include "python/src/bind.h"

namespace hg::python {

void bind_person(nb::module_& module) {
  using config::Scenario;
  module.def(
      "start_posture",
      [](const Scenario& scenario) {
        const scenario::Start start = scenario::find_start(scenario.device, scenario.twin);
        return std::make_tuple(to_numpy(start.q_p), to_numpy(start.q_m));
      },
      nb::arg("scenario"), "(q_p, q_m) of the device where a run begins.");
  nb::class_<person::Person>(module, "Person", "The person of a scenario, at the device's start.")
      .def(
          "__init__",
          [](person::Person* self, const Scenario& scenario) {
            new (self) person::Person(scenario::make_person(
                scenario, scenario::find_start(scenario.device, scenario.twin)));
          },
          nb::arg("scenario"))
      .def(
          "wrench",
          [](person::Person& self, double time_s, const Pose& handle, const ArrayIn& twist,
             const HandTarget& target) {
            return to_numpy(self.wrench(time_s, {handle, vector_of(twist, 6, "twist")}, target));
          },
          nb::arg("time_s"), nb::arg("handle"), nb::arg("twist"), nb::arg("target") = HandTarget{},
          "Wrench on the handle at H, resolved in B, force first; for times that go forward.")
      .def("is_holding", &person::Person::is_holding, nb::arg("time_s"),
           "Whether the hand closes the dead-man switch.");
}

}  // namespace hg::python
