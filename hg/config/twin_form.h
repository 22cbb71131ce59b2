/// The values of a twin that may change while it runs, as the fields of a form: made from the same
/// table, hg/signals/twin_parameter.h, as the list `changes` of scenario.yaml.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hg/controller/rendering/twin_model.h"
#include "hg/signals/frames.h"

namespace hg::config {

struct FormField {
  /// Name such as "hinge.damping_Nms_per_rad": joint, key and for vectors the component
  std::string name;
  std::string group;  ///< name of the joint; empty for the whole twin
  std::string label;  ///< label such as "damping"
  std::string unit;
  std::string help;
  double min = 0.0, max = 0.0;  ///< range that a person may choose from, ends included
  double value = 0.0;           ///< value as the twin is set up; may be infinite
  double step = 0.0;
  std::vector<ParameterChange> changes;  ///< changes that set the field, all to the same value
};

/// Fields of all joints, then those of the whole twin. If the configuration has no upper end, ten
/// times the value or a force that is still comfortable to hold is used.
std::vector<FormField> twin_form(const rendering::TwinModel& twin);

/// Adds the scales of a remote tool, which are at first the same along all axes.
void add_remote_scales(double motion, double force, std::vector<FormField>& form);

/// Index of the field that `change` concerns; -1 = none.
int field_of(const std::vector<FormField>& form, const ParameterChange& change) noexcept;

/// Reason why `value` may not be set while the others are `values` (one per field); empty = it may.
std::string refusal(const std::vector<FormField>& form, int field, double value,
                    const std::vector<double>& values);

}  // namespace hg::config
