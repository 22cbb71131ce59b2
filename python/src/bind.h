/// Parts of the extension module hapticgiant._core, one per file. Every function adds its classes
/// and functions to `module`.
#pragma once

#include <nanobind/nanobind.h>

namespace hg::python {

namespace nb = nanobind;

void bind_limits(nb::module_& module);
void bind_hqp(nb::module_& module);
void bind_haptic_giant(nb::module_& module);
void bind_model(nb::module_& module);
void bind_signals(nb::module_& module);
void bind_cycle(nb::module_& module);
void bind_person(nb::module_& module);
void bind_run(nb::module_& module);
void bind_teleoperation(nb::module_& module);

}  // namespace hg::python
