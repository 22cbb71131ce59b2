/// Binding of a whole run as arrays.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/core/error.h"
#include "hg/recording/column_facts.h"
#include "hg/recording/columns.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"
#include "hg/scenario/session.h"
#include "python/src/bind.h"

namespace hg::python {

namespace {

using recording::Column;
using recording::Columns;

nb::dlpack::dtype type_of(const Column& column) {
  using Code = nb::dlpack::dtype_code;
  const Code code = column.kind == 'b'   ? Code::Bool
                    : column.kind == 'f' ? Code::Float
                    : column.kind == 'u' ? Code::UInt
                                         : Code::Int;
  return {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(8 * column.bytes), 1};
}

// Array of shape (rows), or (rows, width) where a field has more than one number.
nb::object array_of(const Column& column, std::size_t rows) {
  auto* data = new std::vector<std::byte>(recording::padded(column, rows));
  const nb::capsule owner(data,
                          [](void* p) noexcept { delete static_cast<std::vector<std::byte>*>(p); });
  const std::size_t shape[] = {rows, column.width()};
  const std::size_t dimensions = column.is_wide ? 2 : 1;
  return nb::cast(
      nb::ndarray<nb::numpy>(data->data(), dimensions, shape, owner, nullptr, type_of(column)));
}

nb::dict to_dict(const Columns& columns) {
  nb::dict arrays;
  for (const Column& column : columns.all()) {
    arrays[column.name.c_str()] = array_of(column, columns.rows());
  }
  return arrays;
}

constexpr int kCyclesPerLook = 1000;  // between two looks at Ctrl-C

void run_until(scenario::Session& session, double duration_s, double longest_stop_s,
               Columns& columns) {
  double stop_since_s = -1.0;
  for (int look = 1; !session.is_over(); ++look) {
    session.advance();
    columns.append(session.sample());
    const double time_s = session.record().time_s;
    if (time_s >= duration_s && stop_since_s < 0.0) {
      session.stop();
      stop_since_s = time_s;
    }
    if (stop_since_s >= 0.0 && time_s > stop_since_s + longest_stop_s) return;
    if (look % kCyclesPerLook == 0) {
      const nb::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
    }
  }
}

nb::dict run(const config::Scenario& scenario, std::optional<double> duration_s) {
  const double end_s = duration_s.value_or(scenario::planned_duration_s(scenario));
  if (!(std::isfinite(end_s) && end_s > 0.0)) {
    throw SetupError("run: a scenario without a script needs duration_s > 0");
  }
  Columns columns;
  {
    const nb::gil_scoped_release no_gil;
    scenario::Session session(scenario);
    run_until(session, end_s, scenario::longest_stop_s(scenario), columns);
  }
  return to_dict(columns);
}

using recording::KeyValues;

// Metadata "run" and "limits" of a recording of the scenario, as far as columns need them.
std::pair<KeyValues, KeyValues> part_metadata(const config::Scenario& scenario) {
  std::vector<std::string> twin, twin_units;
  for (const model::Joint& joint : scenario.twin.model.chain.joints()) {
    twin.push_back(joint.name);
    const bool is_floating = joint.type == model::JointType::kFloating;
    twin_units.emplace_back(is_floating ? recording::kFloating : joint.is_slide() ? "m" : "rad");
  }
  const auto joined = [](const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
    return text;
  };
  KeyValues limits;
  for (const LimitInfo& limit : scenario.limits) {
    limits.emplace_back(".name", limit.name);
    limits.emplace_back(".unit", limit.is_angle ? "rad" : "m");
  }
  return {{{"gantry_joints", joined(scenario::gantry_joints(scenario.device))},
           {"gantry_units", joined(scenario::gantry_units(scenario.device))},
           {"manipulator_joints", joined(scenario::manipulator_joints(scenario.device))},
           {"manipulator_units", joined(scenario::manipulator_units(scenario.device))},
           {"twin_joints", joined(twin)},
           {"twin_units", joined(twin_units)}},
          limits};
}

nb::dict column_facts(const KeyValues& run, const KeyValues& limits) {
  const recording::RunParts parts(run, limits);
  const Columns columns;
  nb::dict all;
  for (const Column& column : columns.all()) {
    const recording::ColumnFacts facts = parts.facts_of(column);
    all[column.name.c_str()] =
        nb::make_tuple(facts.unit, column.note, facts.axis, facts.labels, facts.units);
  }
  return all;
}

}  // namespace

void bind_run(nb::module_& module) {
  module.def("run_scenario", &run, nb::arg("scenario"), nb::arg("duration_s") = nb::none(),
             "Runs a loaded scenario as fast as it can and returns every cycle as arrays.");
  module.def("part_metadata", &part_metadata, nb::arg("scenario"),
             "Metadata \"run\" and \"limits\" of a recording: names of joints and limits.");
  module.def("column_facts", &column_facts, nb::arg("run"), nb::arg("limits"),
             "Unit, note, axis, labels and units of the entries of every column.");
  module.def(
      "empty_columns", [] { return to_dict(Columns()); },
      "What run_scenario() returns, without a cycle.");
}

}  // namespace hg::python
