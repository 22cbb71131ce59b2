/// Bindings of scenarios, and of their cycle for user-written loops.
#include "hg/controller/cycle.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/cycle_state.h"
#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/model/urdf.h"
#include "hg/runtime/requests.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/session.h"
#include "python/src/arrays.h"
#include "python/src/bind.h"

namespace hg::python {
namespace {

using config::Scenario;
using scenario::Session;

void bind_options(nb::module_& module) {
  using rendering::Bounds;
  using rendering::Law;
  nb::enum_<Law>(module, "Law", "How limits become forces; docs/concepts/law.md.")
      .value("GAUSS", Law::kGauss, "Gauss' principle of least constraint")
      .value("PAPER", Law::kPaper, "[HG] (20)-(26)");
  nb::enum_<Bounds>(module, "Bounds", "How limits become bounds on accelerations.")
      .value("RECOVERABLE", Bounds::kRecoverable)
      .value("PAPER", Bounds::kPaper, "A, B and C of [HG]");
  nb::enum_<rendering::Gantry>(module, "Gantry", "What leads the gantry.")
      .value("RULE", rendering::Gantry::kRule)
      .value("LAW", rendering::Gantry::kLaw, "with law GAUSS");
}

void cap_solver(Scenario& scenario, int active_sets, double from_s, double for_s) {
  const auto require = [](bool holds, const char* rule, double value) {
    if (!holds) throw SetupError(std::string(rule) + ", got " + model::to_text(value));
  };
  require(active_sets >= 1, "active_sets: must be at least 1", active_sets);
  require(std::isfinite(from_s), "from_s: must be finite", from_s);
  require(std::isfinite(for_s) && for_s >= 0.0, "for_s: must not be negative", for_s);
  scenario.faults.push_back({.kind = faults::find_kind("solver_hurried"),
                             .magnitude = static_cast<double>(active_sets),
                             .from_s = from_s,
                             .for_s = for_s});
}

void bind_scenario(nb::module_& module) {
  nb::class_<Scenario>(module, "Scenario", "Device, twin and person of a run.")
      .def_ro("title", &Scenario::title)
      .def_ro("description", &Scenario::description)
      .def_prop_ro("duration_s", &scenario::planned_duration_s,
                   "until everything planned has happened; 0: nothing is planned")
      .def_prop_rw(
          "rate_Hz", [](const Scenario& scenario) { return scenario.device.model.rate_Hz; },
          [](Scenario& scenario, double rate_Hz) {
            config::check_rate(scenario.device, rate_Hz);
            scenario.device.model.rate_Hz = rate_Hz;
          },
          "cycles per second")
      .def_prop_rw(
          "seed", [](const Scenario& scenario) { return scenario.device.simulation.seed; },
          [](Scenario& scenario, std::uint64_t seed) {
            scenario.device.simulation.seed = scenario.device.simulation.sensors.seed = seed;
          },
          "of everything random in the simulation: the same seed gives the same run")
      .def_prop_rw(
          "law", [](const Scenario& scenario) { return scenario.device.rendering.law; },
          [](Scenario& scenario, rendering::Law law) { scenario.device.rendering.law = law; })
      .def_prop_rw(
          "bounds", [](const Scenario& scenario) { return scenario.device.rendering.bounds; },
          [](Scenario& scenario, rendering::Bounds bounds) {
            scenario.device.rendering.bounds = bounds;
          })
      .def_prop_rw(
          "gantry", [](const Scenario& scenario) { return scenario.device.rendering.gantry; },
          [](Scenario& scenario, rendering::Gantry gantry) {
            scenario.device.rendering.gantry = gantry;
          })
      .def(
          "cap_solver", &cap_solver, nb::arg("active_sets"), nb::arg("from_s") = 0.0,
          nb::arg("for_s") = 0.0,
          "Injects the fault solver_hurried: the solver of a cycle ends after so many active sets; "
          "for_s = 0: until the end.")
      .def_ro("limits", &Scenario::limits, "what CycleRecord.limits is about, in its order")
      .def_prop_ro(
          "device",
          [](const Scenario& scenario) { return model::ChainData(scenario.device.model.chain); },
          "copy of the device's chain, gantry first")
      .def_prop_ro(
          "twin",
          [](const Scenario& scenario) { return model::ChainData(scenario.twin.model.chain); },
          "copy of the twin's chain");
  module.def(
      "load_scenario_file", [](const std::string& file) { return config::load_scenario(file); },
      nb::arg("file"), "A scenario from its YAML file; raises SetupError with all faults.");
}

// a Python caller may leave vectors empty or make them too long, C++ code does not
void require_size(const char* name, Eigen::Index expected, Eigen::Index got) {
  if (got != expected) {
    refuse_size(name, expected, got);
  }
}

struct Joints {
  explicit Joints(const Scenario& scenario)
      : gantry(scenario.device.model.n_p), manipulator(scenario.device.model.n_m) {}

  void check(const SensorFrame& sensors) const {
    require_size("sensors.q_m", manipulator, sensors.q_m.size());
    require_size("sensors.dq_m", manipulator, sensors.dq_m.size());
    require_size("sensors.q_p", gantry, sensors.q_p.size());
  }
  void check(const CommandFrame& command) const {
    if (!command.enable) return;
    require_size("command.q_m", manipulator, command.q_m.size());
    require_size("command.dq_m", manipulator, command.dq_m.size());
    require_size("command.dq_p", gantry, command.dq_p.size());
  }

  int gantry, manipulator;
};

struct OwnCycle {
  explicit OwnCycle(const Scenario& scenario)
      : joints(scenario), cycle(scenario::make_cycle(scenario)) {}

  Joints joints;
  controller::Cycle cycle;
};

struct OwnDevice {
  explicit OwnDevice(const Scenario& scenario)
      : joints(scenario), device(scenario::make_simulated_device(scenario)) {}

  Joints joints;
  std::unique_ptr<device::Device> device;
};

void restore(controller::Cycle& cycle, const controller::CycleState& state) {
  const rendering::RenderingState &now = cycle.state().rendering, &then = state.rendering;
  require_size("state: joints", now.reference.q_m.size(), then.reference.q_m.size());
  require_size("state: coordinates of the twin", now.twin.q_a.size(), then.twin.q_a.size());
  require_size("state: gantry", cycle.state().dq_p.size(), state.dq_p.size());
  cycle.restore(state);
}

void bind_parts(nb::module_& module) {
  const nb::class_<controller::CycleState> snapshot(module, "State",
                                                    "All that a cycle remembers; a snapshot.");
  nb::class_<OwnCycle>(module, "Cycle",
                       "One pass of the control loop per step(); no clock, no I/O.")
      .def(nb::init<const Scenario&>(), nb::arg("scenario"))
      .def(
          "step",
          [](OwnCycle& self, const SensorFrame& sensors, const OperatorFrame& operator_input) {
            self.joints.check(sensors);
            std::tuple<CommandFrame, CycleRecord> out;
            self.cycle.step(sensors, operator_input, std::get<0>(out), std::get<1>(out));
            return out;
          },
          nb::arg("sensors"), nb::arg("operator_input") = OperatorFrame{},
          "(command, record). sensors.sequence must count up by one.")
      .def(
          "is_held",
          [](const OwnCycle& self, const SensorFrame& sensors) {
            return self.cycle.is_held(sensors);
          },
          nb::arg("sensors"), "Whether the handle is held; nothing runs otherwise.")
      .def_prop_rw(
          "state", [](const OwnCycle& self) { return self.cycle.state(); },
          [](OwnCycle& self, const controller::CycleState& state) { restore(self.cycle, state); },
          "copy of its memory; assign it to go back");
  nb::class_<OwnDevice>(module, "SimulatedDevice",
                        "The device of a scenario and the person who holds it.")
      .def(nb::init<const Scenario&>(), nb::arg("scenario"))
      .def(
          "read",
          [](OwnDevice& self) {
            SensorFrame sensors;
            self.device->read(sensors);
            return sensors;
          },
          "What the sensors say now.")
      .def(
          "write",
          [](OwnDevice& self, const CommandFrame& command) {
            self.joints.check(command);
            self.device->write(command);
          },
          nb::arg("command"), "Advances by one period.")
      .def_prop_ro(
          "truth", [](const OwnDevice& self) { return *self.device->truth(); },
          "copy of the true state at the last write()");
  module.def("next_request", &runtime::next_request, nb::arg("record"), nb::arg("is_held"),
             nb::arg("is_stopping") = false, "Request of an operator who only wants to run.");
}

void bind_session(nb::module_& module) {
  nb::class_<Session>(module, "Session",
                      "A cycle, its simulated device, and an operator who arms and runs it.")
      .def(nb::init<const Scenario&>(), nb::arg("scenario"))
      .def(
          "step",
          [](Session& self) {
            self.advance();
            return self.record();
          },
          "Advances by one period; the record is a copy.")
      .def(
          "stop", [](Session& self) { self.stop(); }, "Requests a stop from now on.")
      .def_prop_ro(
          "is_over", [](Session& self) { return self.is_over(); },
          "after a fault, or after a requested stop")
      .def_prop_ro("sensors", [](Session& self) { return self.sample().sensors; })
      .def_prop_ro("command", [](Session& self) { return self.sample().command; })
      .def_prop_ro("record", [](Session& self) { return self.record(); })
      .def_prop_ro(
          "teleoperation", [](Session& self) { return self.sample().teleoperation; },
          "the other side of a teleoperation; link NONE where there is none")
      .def_prop_ro(
          "operator_input", [](Session& self) -> OperatorFrame& { return self.input(); },
          nb::rv_policy::reference_internal,
          "what the next step() gets: set hand_target or change in it")
      .def_prop_rw(
          "state", [](Session& self) { return self.cycle().state(); },
          [](Session& self, const controller::CycleState& state) { restore(self.cycle(), state); },
          "of the cycle, not of the simulated world");
}

}  // namespace

void bind_cycle(nb::module_& module) {
  bind_options(module);
  bind_scenario(module);
  bind_parts(module);
  bind_session(module);
}

}  // namespace hg::python
