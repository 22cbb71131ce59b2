#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"
#include "python/src/bind.h"

// Signals before model: poses are bound there, and default arguments need them.
NB_MODULE(_core, module) {
  using namespace hg::python;
  module.doc() =
      "The C++ core of hapticgiant. SI units; arrays that come out are read-only copies.";
  nb::exception<hg::SetupError>(module, "SetupError", PyExc_ValueError).doc() =
      "Bad input: the message names the item, its value and the rule; for files "
      "file:line:column first.";
  module.def(
      "nearest_name",
      [](const std::string& name, const std::vector<std::string>& candidates) {
        return hg::nearest_name(name, candidates);
      },
      nb::arg("name"), nb::arg("candidates"),
      "The candidate with the smallest edit distance to a name.");

  nb::module_ limits =
      module.def_submodule("limits", "Bounds that keep coordinates inside limits.");
  nb::module_ hqp = module.def_submodule("hqp", "Lexicographic least squares with bounds.");
  nb::module_ model = module.def_submodule("model", "Kinematics and dynamics of serial chains.");
  nb::module_ haptic_giant =
      module.def_submodule("haptic_giant", "Kinematics of the HapticGiant in closed form.");
  nb::module_ teleoperation = module.def_submodule(
      "teleoperation", "Trials of methods of bilateral control, with delay, jitter and loss.");
  bind_signals(module);
  bind_limits(limits);
  bind_hqp(hqp);
  bind_model(model);
  bind_haptic_giant(haptic_giant);
  bind_cycle(module);
  bind_person(module);
  bind_run(module);
  bind_teleoperation(teleoperation);
}
