#include "hg/config/twin_form.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hg/config/twin_schema.h"
#include "hg/signals/twin_parameter.h"

namespace hg::config {
namespace {

constexpr int kFineSteps = 200;

double value_of(const rendering::TwinModel& twin, const ParameterChange& change) {
  const std::size_t index = std::max<int>(change.index, 0);
  const rendering::TwinDof& dof = twin.dofs[std::min(index, twin.dofs.size() - 1)];
  switch (change.parameter) {
    case Parameter::kStiffness:
      return dof.stiffness;
    case Parameter::kRest:
      return dof.rest;
    case Parameter::kPreload:
      return dof.preload;
    case Parameter::kDamping:
      return dof.damping;
    case Parameter::kQuadraticDamping:
      return dof.quadratic_damping;
    case Parameter::kFriction:
      return dof.friction;
    case Parameter::kLowerLimit:
      return dof.limits.q_min;
    case Parameter::kUpperLimit:
      return dof.limits.q_max;
    case Parameter::kSpeedLimit:
      return dof.limits.dq_max;
    case Parameter::kReferenceWrench:
      return twin.w_ref[index];
    case Parameter::kGravity:
      return twin.chain.default_loads().gravity;
    case Parameter::kMassScale:
      return twin.mass_scale;
    case Parameter::kFeltScale:
      return twin.felt_scale[index];
    case Parameter::kMotionScale:
    case Parameter::kForceScale:
    case Parameter::kNone:
      break;
  }
  return 0.0;
}

// usual largest value: perceptible and still comfortable to hold
double usual_largest(std::string_view unit) {
  constexpr std::pair<std::string_view, double> kLargest[] = {
      {"Nm/rad", 100.0}, {"N/m", 2000.0}, {"Nms/rad", 20.0},     {"Ns/m", 200.0},
      {"Nm", 10.0},      {"N", 50.0},     {"Nms^2/rad^2", 20.0}, {"Ns^2/m^2", 200.0},
      {"rad", 3.0},      {"m", 2.0},      {"rad/s", 5.0},        {"m/s", 2.0}};
  for (const auto& [name, largest] : kLargest) {
    if (name == unit) return largest;
  }
  return 10.0;
}

// 1, 2 or 5 times a power of ten, not above `value`
double round_step(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= value) return factor * power;
  }
  return power;
}

void fill_range(const ParameterFacts& facts, FormField& field) {
  const bool is_flag = facts.parameter == Parameter::kGravity;
  const double size = std::isfinite(field.value) ? 10.0 * std::abs(field.value) : 0.0;
  const double largest = std::max(size, usual_largest(field.unit));
  field.max = facts.range.ub < kLargestParameter ? facts.range.ub : largest;
  field.min = facts.range.lb > -kLargestParameter ? facts.range.lb : -largest;
  field.step = is_flag ? 1.0 : round_step((field.max - field.min) / kFineSteps);
  if (facts.excludes_lb) field.min = field.step;
}

// Words and unit of a field; value and range follow from the model.
struct FieldText {
  std::string group, key, label, help;
};

// A field that sets `count` parameters of the same kind from `index` on, all to one value.
FormField make_field(const rendering::TwinModel& twin, const FieldText& text, Parameter parameter,
                     int index, int count = 1) {
  FormField field;
  field.name = text.group.empty() ? text.key : text.group + '.' + text.key;
  field.group = text.group;
  field.label = text.label;
  field.help = text.help;
  // a component such as ".x" is no part of the unit
  field.unit = unit_of(std::string_view(text.key).substr(0, text.key.rfind('.')));
  for (int i = 0; i < count; ++i) {
    field.changes.push_back({parameter, static_cast<std::int16_t>(index + i), 0.0});
  }
  field.value = value_of(twin, field.changes.front());
  fill_range(facts_of(parameter), field);
  return field;
}

void add_joint(const rendering::TwinModel& twin, const model::Joint& joint,
               std::vector<FormField>& form) {
  if (joint.type == model::JointType::kFloating) {
    for (const FloatingParameter& key : kFloatingParameters) {
      form.push_back(make_field(
          twin, {joint.name, std::string(key.key), std::string(key.label), std::string(key.help)},
          key.parameter, joint.v_index + key.first_dof, 3));
    }
    return;
  }
  for (const ParameterFacts& facts : kParameters) {
    if (facts.owner != ParameterOwner::kDof && facts.owner != ParameterOwner::kJoint) continue;
    const std::string key(key_of(facts).of(unit_of(joint.type)));
    form.push_back(make_field(twin,
                              {joint.name, key, std::string(facts.label), std::string(facts.help)},
                              facts.parameter, joint.v_index));
  }
}

void add_wrench(const rendering::TwinModel& twin, Parameter parameter,
                std::vector<FormField>& form) {
  const std::string group(facts_of(parameter).key);
  for (const WrenchParameter& part : parts_of(parameter)) {
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      form.push_back(make_field(twin,
                                {"", group + '.' + std::string(part.key) + '.' + axis,
                                 std::string(part.label) + ' ' + axis, std::string(part.help)},
                                parameter, part.first_component + i));
    }
  }
}

}  // namespace

std::vector<FormField> twin_form(const rendering::TwinModel& twin) {
  std::vector<FormField> form;
  for (const model::Joint& joint : twin.chain.joints()) add_joint(twin, joint, form);
  for (const ParameterFacts& facts : kParameters) {
    if (facts.owner == ParameterOwner::kWrench) add_wrench(twin, facts.parameter, form);
  }
  for (const ParameterFacts& facts : kParameters) {
    if (facts.owner != ParameterOwner::kTwin) continue;
    form.push_back(make_field(
        twin, {"", std::string(facts.key), std::string(facts.label), std::string(facts.help)},
        facts.parameter, -1));
  }
  return form;
}

void add_remote_scales(double motion, double force, std::vector<FormField>& form) {
  for (const Parameter parameter : {Parameter::kMotionScale, Parameter::kForceScale}) {
    const ParameterFacts& facts = facts_of(parameter);
    const double value = parameter == Parameter::kMotionScale ? motion : force;
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      FormField field = {.name = std::string(facts.key) + '.' + axis,
                         .label = std::string(facts.label) + ' ' + axis,
                         .help = std::string(facts.help),
                         .value = value,
                         .changes = {{parameter, static_cast<std::int16_t>(i), 0.0}}};
      fill_range(facts, field);
      field.max = 10.0 * std::max(1.0, value);
      field.step = 0.01;
      form.push_back(std::move(field));
    }
  }
}

int field_of(const std::vector<FormField>& form, const ParameterChange& change) noexcept {
  for (std::size_t i = 0; i < form.size(); ++i) {
    const ParameterChange& first = form[i].changes.front();
    if (first.parameter == change.parameter && first.index == change.index) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

std::string refusal(const std::vector<FormField>& form, int field, double value,
                    const std::vector<double>& values) {
  const FormField& wanted = form[field];
  if (!(value >= wanted.min && value <= wanted.max)) {
    return wanted.name + ": must be " + Bounds({.lb = wanted.min, .ub = wanted.max}, "").text() +
           " " + wanted.unit + ", got " + model::to_text(value);
  }
  const ParameterChange& change = wanted.changes.front();
  const auto other = [&](Parameter parameter) {
    const int index = field_of(form, {parameter, change.index});
    return values[index];
  };
  const bool crosses =
      (change.parameter == Parameter::kLowerLimit && value > other(Parameter::kUpperLimit)) ||
      (change.parameter == Parameter::kUpperLimit && value < other(Parameter::kLowerLimit));
  return crosses ? wanted.name + ": the limits would cross" : "";
}

}  // namespace hg::config
