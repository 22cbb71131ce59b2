/// Binding of an enum with all its enumerators, taken from the compiler.
#pragma once

#include <nanobind/nanobind.h>

#include <deque>
#include <string>

#include "hg/core/enumerators.h"

namespace hg::python {

/// Binds an enum as an arithmetic Python enum. Values below `kEnd`; names like STILL_MOVING.
template <typename E, std::size_t kEnd = 64>
void bind_enum(nanobind::module_& module, const char* name, const char* doc) {
  static std::deque<std::string> names;  // nanobind keeps the pointers
  nanobind::enum_<E> bound(module, name, nanobind::is_arithmetic(), doc);
  for (const Enumerator<E>& one : enumerators<E, kEnd>()) {
    bound.value(names.emplace_back(constant_name(one.name)).c_str(), one.value);
  }
}

}  // namespace hg::python
