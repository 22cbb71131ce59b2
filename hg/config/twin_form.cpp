#include "hg/config/twin_form.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "hg/config/describe_changes.h"
#include "hg/config/scenario.h"

namespace hg::config {
namespace {

constexpr double kMark = 1.0;  // any value that all ranges allow
constexpr int kFineSteps = 200;

// Visitor that lists the keys of a change and sets the one with the number `wanted`.
class KeyLister {
 public:
  struct Key {
    std::string name;
    std::string_view unit, text;
    Range range;
    bool is_flag = false;
  };

  KeyLister(int joint, int wanted) : joint_(joint), wanted_(wanted) {}

  std::vector<Key> keys;

  bool number(std::string_view key, double& value, const Range& range, std::string_view text,
              Need need = Need::kOptional) {
    if (need == Need::kRequired) return false;  // when, not what
    return add({prefix_ + std::string(key), unit_of(key), text, range}, value);
  }
  bool joint_number(const JointKey& key, JointUnit unit, double& value, const Range& range,
                    std::string_view text) {
    return number(key.of(unit), value, range, text);
  }
  bool vector(std::string_view key, Eigen::Vector3d& value, const Range& range,
              std::string_view text) {
    for (int i = 0; i < 3; ++i) {
      std::string name = prefix_ + std::string(key) + '.';
      name.push_back("xyz"[i]);
      add({name, unit_of(key), text, range}, value[i]);
    }
    return true;
  }
  bool flag(std::string_view key, bool& value, std::string_view text) {
    double number = 0.0;
    value = add({prefix_ + std::string(key), "", text, {0.0, 1.0}, true}, number);
    return value;
  }
  bool name(std::string_view, int& index, const std::vector<std::string>&, std::string_view,
            std::string_view) {
    index = std::max(joint_, 0);
    return true;
  }
  bool group(std::string_view key, const std::function<void(KeyLister&)>& read, std::string_view) {
    prefix_.assign(key).push_back('.');
    read(*this);
    prefix_.clear();
    return true;
  }
  void rule(bool, std::string_view, std::string_view, std::string_view = {}) {}
  bool is_given(std::string_view) const { return joint_ >= 0; }
  bool covers(bool applies) const { return applies; }

 private:
  bool add(const Key& key, double& value) {
    const bool is_wanted = static_cast<int>(keys.size()) == wanted_;
    keys.push_back(key);
    if (is_wanted) value = kMark;
    return is_wanted;
  }

  int joint_, wanted_;
  std::string prefix_;
};

// Keys of a change of `joint` (-1: of the whole twin) and what the wanted one sets.
std::pair<std::vector<KeyLister::Key>, std::vector<ParameterChange>> list(ChangesDraft draft,
                                                                          int joint, int wanted) {
  KeyLister lister(joint, wanted);
  describe(lister, draft);
  std::vector<ParameterChange> changes;
  for (const TimedChange& timed : draft.changes) changes.push_back(timed.change);
  return {std::move(lister.keys), std::move(changes)};
}

double value_of(const rendering::TwinModel& twin, const ParameterChange& change) {
  const auto index = static_cast<std::size_t>(std::max<int>(change.index, 0));
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
      return twin.w_ref[static_cast<Eigen::Index>(index)];
    case Parameter::kGravity:
      return twin.chain.default_loads().gravity;
    case Parameter::kMassScale:
      return twin.mass_scale;
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

void fill_range(const KeyLister::Key& key, FormField& field) {
  const double size = std::isfinite(field.value) ? 10.0 * std::abs(field.value) : 0.0;
  const double largest = std::max(size, usual_largest(field.unit));
  field.max = std::isfinite(key.range.ub) ? key.range.ub : largest;
  field.min = std::isfinite(key.range.lb) ? key.range.lb : -largest;
  field.step = key.is_flag ? 1.0 : round_step((field.max - field.min) / kFineSteps);
  if (key.range.excludes_lb) field.min = field.step;
}

// "damping" of "damping_Nms_per_rad", "force x" of "reference_wrench.force_N.x"
std::string label_of(std::string_view key) {
  std::string_view component;
  if (key.size() > 2 && key[key.size() - 2] == '.') {
    component = key.substr(key.size() - 1);
    key.remove_suffix(2);
  }
  key.remove_prefix(key.find('.') + 1);  // removes the group; npos + 1 is 0
  for (const std::string_view suffix :
       {"_Nms2_per_rad2", "_Ns2_per_m2", "_Nms_per_rad", "_Ns_per_m", "_Nm_per_rad", "_N_per_m",
        "_rad_per_s", "_m_per_s", "_Nm", "_N", "_rad", "_m"}) {
    if (!key.ends_with(suffix)) continue;
    key.remove_suffix(suffix.size());
    break;
  }
  for (const auto& [symbol, words] :
       {std::pair("q_min", "lowest position"), std::pair("q_max", "highest position"),
        std::pair("dq_max", "largest speed")}) {
    if (key == symbol) return words;
  }
  std::string label(key);
  std::replace(label.begin(), label.end(), '_', ' ');
  if (!component.empty()) label += ' ';
  return label.append(component);
}

void add_fields(const rendering::TwinModel& twin, const ChangesDraft& draft, int joint,
                std::vector<FormField>& form) {
  const auto [keys, nothing] = list(draft, joint, -1);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    FormField field;
    field.changes = list(draft, joint, static_cast<int>(i)).second;
    const ParameterChange& first = field.changes.front();
    // a joint's list ends with what belongs to the whole twin
    const bool is_of_twin = first.parameter == Parameter::kReferenceWrench || first.index < 0;
    if (is_of_twin != (joint < 0)) continue;
    if (joint >= 0) field.group = field.name = draft.joint_names[static_cast<std::size_t>(joint)];
    if (joint >= 0) field.name += '.';
    field.name += keys[i].name;
    field.label = label_of(keys[i].name);
    field.unit = keys[i].unit;
    field.help = keys[i].text;
    field.value = value_of(twin, first);
    fill_range(keys[i], field);
    form.push_back(std::move(field));
  }
}

}  // namespace

std::vector<FormField> twin_form(const rendering::TwinModel& twin) {
  const ChangesDraft draft = changes_of(twin);
  std::vector<FormField> form;
  for (int joint = 0; joint < static_cast<int>(draft.joints.size()); ++joint) {
    add_fields(twin, draft, joint, form);
  }
  add_fields(twin, draft, -1, form);
  return form;
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
  const FormField& wanted = form[static_cast<std::size_t>(field)];
  if (!(value >= wanted.min && value <= wanted.max)) {
    return wanted.name + ": must be " + Bounds({.lb = wanted.min, .ub = wanted.max}, "").text() +
           " " + wanted.unit + ", got " + model::to_text(value);
  }
  const ParameterChange& change = wanted.changes.front();
  const auto other = [&](Parameter parameter) {
    const int index = field_of(form, {parameter, change.index});
    return values[static_cast<std::size_t>(index)];
  };
  const bool crosses =
      (change.parameter == Parameter::kLowerLimit && value > other(Parameter::kUpperLimit)) ||
      (change.parameter == Parameter::kUpperLimit && value < other(Parameter::kLowerLimit));
  return crosses ? wanted.name + ": the limits would cross" : "";
}

}  // namespace hg::config
