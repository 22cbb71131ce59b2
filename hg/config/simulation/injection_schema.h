/// Description of the injected faults in a scenario.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/core/index.h"
#include "hg/simulator/faults/injection.h"

namespace hg::config {

/// Content of the list `faults`.
struct InjectionsDraft {
  std::vector<std::string> manipulator, gantry;  ///< joint names
  std::vector<std::string> components;           ///< components of the sensor at the handle
  std::vector<std::string> inputs;               ///< inputs of the safety controller
  std::vector<std::string> names;                ///< names of everything that a fault may concern
  std::vector<std::string> kinds;
  std::vector<faults::Injection> injections;
};

/// Draft without faults.
inline InjectionsDraft injections_of(const std::vector<std::string>& manipulator,
                                     const std::vector<std::string>& gantry) {
  InjectionsDraft draft = {
      .manipulator = manipulator,
      .gantry = gantry,
      .components = {"x", "y", "z", "torque x", "torque y", "torque z"},
      .inputs = {"stop buttons", "operator enable", "dead-man switch", "override key"}};
  for (const auto* parts : {&draft.manipulator, &draft.gantry, &draft.components, &draft.inputs}) {
    draft.names.insert(draft.names.end(), parts->begin(), parts->end());
  }
  for (const faults::Kind& kind : faults::kinds()) draft.kinds.emplace_back(kind.name);
  return draft;
}

/// Index among the parts of `kind` of the entry `name` of InjectionsDraft::names; -1 = none of
/// them.
inline int part_index(const InjectionsDraft& d, const faults::Kind& kind, int name) {
  const int n_m = static_cast<int>(d.manipulator.size()), n_p = static_cast<int>(d.gantry.size());
  const int components = static_cast<int>(d.components.size());
  int first = 0;
  switch (kind.part) {
    case faults::Part::kGantryEncoder:
    case faults::Part::kGantryDrive:
    case faults::Part::kGantryCoupling:
      first = n_m;
      break;
    case faults::Part::kForceSensor:
    case faults::Part::kAccelerometer:
    case faults::Part::kGyroscope:
      first = n_m + n_p;
      break;
    case faults::Part::kSafetyChannel:
      first = n_m + n_p + components;
      break;
    default:
      break;
  }
  const int index = name - first;
  return index >= 0 && index < faults::parts_of(kind.part, n_m, n_p) ? index : -1;
}

template <class V>
void describe(V& v, InjectionsDraft& d) {
  faults::Injection& fault = d.injections.emplace_back();
  int kind = 0, name = -1;
  double magnitude = kNoDefault;
  v.number("at_s", fault.from_s, kNotNegative, "when the fault begins, on the device's clock",
           Need::kRequired);
  v.number("for_s", fault.for_s, kNotNegative, "how long it lasts; 0: until the end");
  v.name("fault", kind, d.kinds, "a fault",
         "what goes wrong, see the list in docs/reports/fault_campaign.md", Need::kRequired);
  v.name(
      "of", name, d.names, "a joint, a component or an input",
      "a joint; x, y, z, torque x, torque y, torque z of the sensor at the handle; stop buttons, "
      "operator enable, dead-man switch, override key of the safety controller");
  v.number("magnitude", magnitude, {.lb = -1e6, .ub = 1e6},
           "how much of it; unit and usual sizes in docs/reports/fault_campaign.md");

  fault.kind = &faults::kinds()[kind];
  const int n_m = static_cast<int>(d.manipulator.size()), n_p = static_cast<int>(d.gantry.size());
  const bool has_parts = faults::parts_of(fault.kind->part, n_m, n_p) > 0;
  if (has_parts) fault.index = part_index(d, *fault.kind, name);
  v.rule(!has_parts || fault.index >= 0, "of",
         "this fault needs one of its joints, components or inputs");
  v.rule(has_parts || name < 0, "of", "this fault concerns no single joint, component or input");
  const bool has_magnitude = !fault.kind->unit.empty();
  v.rule(has_magnitude == !std::isnan(magnitude), "magnitude",
         has_magnitude ? "this fault needs a magnitude" : "this fault has no magnitude");
  v.rule(!has_magnitude || fault.kind->has_sign || !(magnitude < 0.0), "magnitude",
         "must not be negative for this fault");
  v.rule(fault.kind->effect != faults::Effect::kLate ||
             !(magnitude > static_cast<double>(faults::kMostLate)),
         "magnitude", "must be at most " + std::to_string(faults::kMostLate) + " periods");
  const bool is_counted =
      magnitude >= 1.0 && magnitude <= faults::kMostCounted && magnitude == std::floor(magnitude);
  v.rule(!faults::is_count(*fault.kind) || magnitude < 0.0 || std::isnan(magnitude) || is_counted,
         "magnitude",
         fmt::format("must be a whole number of {} from 1 to {:.0f}", fault.kind->unit,
                     faults::kMostCounted));
  if (has_magnitude) fault.magnitude = magnitude;
}

template <class V>
void describe_injections(V& v, InjectionsDraft& d) {
  v.list(
      "faults", [&](auto& child) { describe(child, d); },
      "injected faults, which only a simulated device plays");
}

}  // namespace hg::config
