/// The remote machine of a teleoperation, for Python; part of the extension hapticgiant._run.
#pragma once

#include <nanobind/nanobind.h>

namespace hg::python {

void bind_remote(nanobind::module_& module);

}  // namespace hg::python
