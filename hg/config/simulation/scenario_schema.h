/// Description of scenario.yaml.
#pragma once

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/sources.h"
#include "hg/config/twin_schema.h"
#include "hg/controller/rendering/surfaces/environment.h"
#include "hg/core/index.h"
#include "hg/signals/event_rule.h"
#include "hg/signals/timed_changes.h"
#include "hg/signals/timed_panel.h"
#include "hg/simulator/faults/injection.h"
#include "hg/simulator/person/person.h"
#include "hg/simulator/plant/bystander.h"

namespace hg::config {

// ---- surfaces ----

enum class SurfaceShape { kPlane, kBox, kSphere, kCylinder, kMesh };

inline constexpr auto kContacts = choices_of<surfaces::Contact>();

inline constexpr auto kSurfaceShapes = choices_of<SurfaceShape>();

/// Content of an item of `surfaces`, before it becomes a Surface.
struct SurfaceDraft {
  surfaces::Surface surface;  ///< surface without its shape, place and damping
  SurfaceShape shape = SurfaceShape::kPlane;
  Eigen::Vector3d size = Eigen::Vector3d::Constant(kNoDefault);
  double radius = 0.0, length = 0.0, scale = 1.0;
  double damping = kNoDefault;
  std::filesystem::path mesh;
  Placement placement;
};

constexpr Range range_of(const Interval& interval) {
  return {.lb = interval.lb, .ub = interval.ub};
}

template <class V>
void describe_shape(V& v, SurfaceDraft& d) {
  const Range length = range_of(surfaces::kSize);
  v.choice("shape", d.shape, kSurfaceShapes,
           "a plane is hard where z < 0 in its own frame; the others are solids");
  if (v.covers(d.shape == SurfaceShape::kBox)) {
    v.vector("size_m", d.size, length, "edges of a box along its x, y, z");
    v.rule(v.is_given("size_m"), "", "a box needs 'size_m'");
  }
  if (v.covers(d.shape == SurfaceShape::kSphere || d.shape == SurfaceShape::kCylinder)) {
    v.number("radius_m", d.radius, length, "of a sphere or cylinder", Need::kRequired);
  }
  if (v.covers(d.shape == SurfaceShape::kCylinder)) {
    v.number("length_m", d.length, length, "of a cylinder, along its z", Need::kRequired);
  }
  if (v.covers(d.shape == SurfaceShape::kMesh)) {
    v.path("mesh", d.mesh, "STL file of a mesh, binary or text", Need::kRequired);
    v.number("scale", d.scale, {.lb = 1e-9, .ub = 1e3},
             "of a mesh, m per unit of the file; 0.001 for mm");
  }
}

template <class V>
void describe(V& v, std::vector<SurfaceDraft>& surfaces) {
  SurfaceDraft& d = surfaces.emplace_back();
  v.words("name", d.surface.name, "for the page and for messages", Need::kRequired);
  const auto same = [&](const SurfaceDraft& other) { return other.surface.name == d.surface.name; };
  v.rule(std::count_if(surfaces.begin(), surfaces.end(), same) == 1, "name",
         "surfaces must not use a name twice");
  describe_shape(v, d);
  v.group(
      "placement", [&](auto& child) { describe(child, d.placement); },
      "of the surface in B; without it, its frame is B");
  v.choice("contact", d.surface.contact, kContacts,
           "spring: pushes out what enters; stop: brakes the twin before it, like its own limits");
  const bool is_stop = d.surface.contact == surfaces::Contact::kStop;
  for (const char* key : {"stiffness_N_per_m", "damping_Ns_per_m", "friction"}) {
    v.rule(!is_stop || !v.is_given(key), key, "a surface that is a stop has no such key");
  }
  v.number("stiffness_N_per_m", d.surface.stiffness, range_of(surfaces::kStiffness),
           "of the spring between handle and surface");
  v.number("damping_Ns_per_m", d.damping, range_of(surfaces::kDamping),
           "against the motion of the handle inside; without it critical for the twin, and the "
           "surface catches what meets it, docs/concepts/environment.md");
  v.number("friction", d.surface.friction, range_of(surfaces::kFriction),
           "coefficient of Coulomb friction");
}

template <class V>
void describe_surfaces(V& v, std::vector<SurfaceDraft>& surfaces) {
  v.list(
      "surfaces", [&](auto& child) { describe(child, surfaces); },
      "virtual surfaces that push the twin, docs/concepts/environment.md");
  v.rule(surfaces.size() <= surfaces::kMaxSurfaces, "surfaces", "at most 64 surfaces");
}

/// The surface of a draft; reads the file of a mesh. Throws SetupError.
surfaces::Surface surface_of(const SurfaceDraft& draft, SourceReader& reader);

// ---- bystander ----

/// A bystander whom the arm may hit, before frames have numbers.
struct BystanderDraft {
  std::vector<std::string> parts;   ///< names of body parts
  std::vector<std::string> frames;  ///< frame names of the device
  std::string hit_by;               ///< frame that hits, one of `frames`
  std::optional<simulator::BystanderConfig> bystander;
};

inline BystanderDraft bystander_of(const std::vector<std::string>& frames) {
  BystanderDraft draft = {.frames = frames};
  for (const simulator::BodyPart& part : simulator::kBodyParts) draft.parts.emplace_back(part.name);
  return draft;
}

template <class V>
void describe(V& v, BystanderDraft& d, simulator::BystanderConfig& bystander) {
  int part = 0, frame = 0;
  v.name("body_part", part, d.parts, "a part of the body",
         "what is hit: its stiffness, mass and permissible values are those of ISO/TS 15066",
         Need::kRequired);
  v.name("hit_by", frame, d.frames, "a link of the URDF", "whose origin hits it", Need::kRequired);
  bystander.position = bystander.facing = Eigen::Vector3d::Constant(kNoDefault);
  v.vector("position_m", bystander.position, {.lb = -1e3, .ub = 1e3},
           "of the skin in B; must be given");
  v.vector("facing", bystander.facing, {.lb = -1.0, .ub = 1.0},
           "direction out of the skin in B, must be given; only what comes from there is met");
  v.rule(v.is_given("position_m") && v.is_given("facing"), "",
         "a bystander needs 'position_m' and 'facing'");
  v.flag("is_clamped", bystander.is_clamped,
         "it stands against a wall; otherwise it is pushed away");
  v.rule(!v.is_given("facing") || bystander.facing.norm() > 1e-3, "facing",
         "must not be a zero vector");
  if (d.frames.empty()) return;  // the reference page
  bystander.part = &simulator::kBodyParts[part];
  d.hit_by = d.frames[frame];
}

template <class V>
void describe_bystander(V& v, BystanderDraft& d) {
  v.group(
      "bystander",
      [&](auto& child) {
        d.bystander.emplace();
        describe(child, d, *d.bystander);
      },
      "a person in the way of the arm, whom only a simulated device can hit, "
      "docs/concepts/compliance.md");
}

// ---- switches of the panel ----

inline constexpr std::array<Choice<ModeRequest>, 6> kRequests = {
    {{"arm", ModeRequest::kArm},
     {"run", ModeRequest::kRun},
     {"run_alone", ModeRequest::kAutonomous},
     {"stop", ModeRequest::kStop},
     {"reset", ModeRequest::kReset},
     {"tare", ModeRequest::kTare}}};

template <class V>
void describe(V& v, std::vector<TimedPanel>& panels) {
  TimedPanel now;
  if (!panels.empty()) now = panels.back();  // values not given stay unchanged
  const double last_s = now.at_s;
  now.request = ModeRequest::kNone;
  now.panel.reset = false;
  v.number("at_s", now.at_s, kNotNegative, "when this is done", Need::kRequired);
  v.rule(now.at_s >= last_s, "at_s", "events must be in the order of their times");
  v.flag("emergency_stop", now.panel.emergency_stop, "whether the stop button is pressed");
  v.flag("operator_enable", now.panel.operator_enable, "whether the enabling switch is held");
  v.flag("override_key", now.panel.override_key, "whether the override key is turned");
  v.flag("person_in_field", now.panel.person_in_field,
         "whether a person besides the user is in the scanner's field");
  v.flag("reset", now.panel.reset, "presses the reset button of the safety controller");
  v.choice("request", now.request, kRequests,
           "requested mode; after the first request other than a tare none is made automatically");
  panels.push_back(now);
}

template <class V>
void describe_panel(V& v, std::vector<TimedPanel>& panels) {
  v.list(
      "panel", [&](auto& child) { describe(child, panels); },
      "what a simulated operator does; first the switch is held and nothing else is touched; what "
      "an entry does not give stays as it is");
}

// ---- injected faults ----

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

// ---- changes of the twin while it runs ----

/// A joint of the twin, as needed to check changes.
struct ChangeJoint {
  JointUnit unit = JointUnit::kEither;
  bool is_floating = false;
  int dof = 0;     ///< index of its first degree of freedom
  Interval range;  ///< range of its positions, after the changes so far
};

/// Content of the list `changes`.
struct ChangesDraft {
  std::vector<std::string> joint_names;
  std::vector<ChangeJoint> joints;
  std::vector<TimedChange> changes;

  void add(double at_s, Parameter parameter, int index, double value) {
    if (std::isnan(value)) return;
    changes.push_back({at_s, {parameter, static_cast<std::int16_t>(index), value}});
  }
};

/// Draft for the joints of `twin`, without changes.
inline ChangesDraft changes_of(const rendering::TwinModel& twin) {
  ChangesDraft draft;
  for (const model::Joint& joint : twin.chain.joints()) {
    const limits::JointLimits& limits = twin.dofs[joint.v_index].limits;
    draft.joint_names.push_back(joint.name);
    draft.joints.push_back({.unit = unit_of(joint.type),
                            .is_floating = joint.type == model::JointType::kFloating,
                            .dof = joint.v_index,
                            .range = {limits.q_min, limits.q_max}});
  }
  return draft;
}

template <class V>
void describe_change(V& v, ChangesDraft& d, double at_s, ChangeJoint& joint) {
  constexpr auto kNumber = [](Parameter parameter) { return index(parameter); };
  std::array<double, kParameters.size() + 1> values;  // by number of the parameter
  values.fill(kNoDefault);
  for (const ParameterFacts& facts : kParameters) {
    const bool is_of_joint =
        facts.owner == ParameterOwner::kDof || facts.owner == ParameterOwner::kJoint;
    if (!is_of_joint) continue;
    describe_parameter(v, facts.parameter, values[kNumber(facts.parameter)], joint.unit);
    const bool is_end =
        facts.parameter == Parameter::kLowerLimit || facts.parameter == Parameter::kUpperLimit;
    if (!is_end) d.add(at_s, facts.parameter, joint.dof, values[kNumber(facts.parameter)]);
  }

  // one end after the other, so that the range is never empty
  const double q_min = values[kNumber(Parameter::kLowerLimit)];
  const double q_max = values[kNumber(Parameter::kUpperLimit)];
  if (q_min > joint.range.ub) d.add(at_s, Parameter::kUpperLimit, joint.dof, q_max);
  d.add(at_s, Parameter::kLowerLimit, joint.dof, q_min);
  if (!(q_min > joint.range.ub)) d.add(at_s, Parameter::kUpperLimit, joint.dof, q_max);
  if (!std::isnan(q_min)) joint.range.lb = q_min;
  if (!std::isnan(q_max)) joint.range.ub = q_max;
  v.rule(!joint.range.empty(), key_of(facts_of(Parameter::kUpperLimit)).of(joint.unit),
         "q_max must not be below q_min",
         model::to_text(joint.range.ub) + " with q_min " + model::to_text(joint.range.lb));
}

template <class V>
void describe_floating_change(V& v, ChangesDraft& d, double at_s, int dof) {
  FloatingPart part;
  part.values.fill(kNoDefault);
  describe_forces(v, part);
  for (std::size_t k = 0; k < kFloatingParameters.size(); ++k) {
    const FloatingParameter& key = kFloatingParameters[k];
    for (int i = 0; i < 3; ++i) {
      d.add(at_s, key.parameter, dof + key.first_dof + i, part.values[k]);
    }
  }
}

template <class V>
void describe(V& v, ChangesDraft& d) {
  const double last_s = d.changes.empty() ? 0.0 : d.changes.back().at_s;
  const std::size_t before = d.changes.size();
  double at_s = last_s, mass_scale = kNoDefault;
  v.number("at_s", at_s, kNotNegative, "when the change begins", Need::kRequired);
  v.rule(at_s >= last_s, "at_s", "changes must be in the order of their times");
  int index = 0;
  v.name("joint", index, d.joint_names, "a joint of the twin",
         "whose values change; the other keys are those of twin.yaml");
  ChangeJoint& joint = d.joints[index];
  const bool has_joint = v.is_given("joint");
  if (v.covers(has_joint && !joint.is_floating)) describe_change(v, d, at_s, joint);
  if (v.covers(has_joint && joint.is_floating)) describe_floating_change(v, d, at_s, joint.dof);

  Eigen::Vector3d force = Eigen::Vector3d::Constant(kNoDefault), torque = force;
  describe_reference_wrench(v, force, torque);
  for (int i = 0; i < 3; ++i) d.add(at_s, Parameter::kReferenceWrench, i, force[i]);
  for (int i = 0; i < 3; ++i) d.add(at_s, Parameter::kReferenceWrench, 3 + i, torque[i]);
  bool gravity = false;
  if (v.flag(facts_of(Parameter::kGravity).key, gravity, facts_of(Parameter::kGravity).help)) {
    d.add(at_s, Parameter::kGravity, -1, gravity ? 1.0 : 0.0);
  }
  describe_mass_scale(v, mass_scale);
  d.add(at_s, Parameter::kMassScale, -1, mass_scale);
  v.rule(d.changes.size() > before, "", "a change needs at least one value");
}

template <class V>
void describe_changes(V& v, ChangesDraft& d) {
  v.list(
      "changes", [&](auto& child) { describe(child, d); },
      "values of the twin that change during the run, approached within a second");
}

// ---- top keys ----

/// Names that events may use, and their meaning.
struct EventNames {
  std::vector<std::string> limits;       ///< limits of the catalogue
  std::vector<std::string> twin_joints;  ///< twin joints that are not floating
  std::vector<int> twin_limits;          ///< indices of the twin joints in the catalogue
  std::vector<int> twin_coordinates;     ///< indices of the twin joints in q_a
  std::vector<std::string> manipulator;
  std::vector<std::string> gantry;
  std::vector<std::string> surfaces;
};

/// Content of scenario.yaml, before it becomes a Scenario.
struct ScenarioDraft {
  std::string title, description;
  std::filesystem::path device, twin, script;
  person::PersonKind person = person::PersonKind::kScript;
  double duration_s = 0.0;
  EventNames names;
  std::vector<EventRule> events;
};

inline constexpr std::array<Choice<person::PersonKind>, 2> kPersons = {
    {{"mouse", person::PersonKind::kMouse}, {"none", person::PersonKind::kNone}}};
inline constexpr std::array<Choice<LimitState>, 2> kSides = {
    {{"lower", LimitState::kLower}, {"upper", LimitState::kUpper}}};

template <class V>
void describe_parts(V& v, ScenarioDraft& d) {
  v.words("title", d.title, "one line", Need::kRequired);
  v.words("description", d.description, "one sentence", Need::kRequired);
  v.path("device", d.device, "device.yaml", Need::kRequired);
  v.path("twin", d.twin, "twin.yaml", Need::kRequired);
  v.path_or_choice("person", d.script, d.person, kPersons,
                   "script.yaml of the hand, or mouse, or none", Need::kRequired);
  v.number("duration_s", d.duration_s, kPositive,
           "length of the run, from when a scripted hand takes the handle", Need::kRequired);
}

/// Conditions on single limits and surfaces.
template <class V>
void describe_limit_conditions(V& v, const EventNames& names, EventRule& event) {
  LimitState side = LimitState::kInactive;
  v.choice("side", side, kSides, "of limit and speed_limit; without it either side");
  int index = 0;
  if (v.name("limit", index, names.limits, "a limit", "this limit is felt")) {
    event.all_of.push_back({.kind = ConditionKind::kLimit, .index = index, .side = side});
  }
  if (v.name("speed_limit", index, names.limits, "a limit", "its largest speed is felt")) {
    event.all_of.push_back({.kind = ConditionKind::kSpeedLimit, .index = index, .side = side});
  }
  if (v.name("locked", index, names.twin_joints, "a joint of the twin", "a lock holds it")) {
    const int limit = names.twin_limits[index];
    event.all_of.push_back({.kind = ConditionKind::kLocked, .index = limit});
  }
  if (v.name("surface", index, names.surfaces, "a surface of the scenario",
             "of all virtual surfaces this one pushes the twin most")) {
    event.all_of.push_back({.kind = ConditionKind::kSurface, .index = index});
  }
}

template <class V>
void describe_conditions(V& v, const EventNames& names, EventRule& event) {
  describe_limit_conditions(v, names, event);
  const auto number = [&](const char* key, ConditionKind kind, const char* text) {
    double value = kNoDefault;
    if (v.number(key, value, kNotNegative, text)) {
      event.all_of.push_back({.kind = kind, .value = value});
    }
  };
  const auto by_name = [&](const char* key, ConditionKind kind, const std::vector<std::string>& of,
                           const char* what, const char* text) {
    v.numbers_by_name(
        key, of, what, kJointPosition,
        [&](int index, double value) {
          const bool is_twin =
              kind == ConditionKind::kTwinAbove || kind == ConditionKind::kTwinBelow;
          if (is_twin) index = names.twin_coordinates[index];
          event.all_of.push_back({.kind = kind, .index = index, .value = value});
        },
        text);
  };
  number("force_above_N", ConditionKind::kForceAbove, "norm of the user's force");
  number("force_below_N", ConditionKind::kForceBelow, "norm of the user's force");
  by_name("twin_above", ConditionKind::kTwinAbove, names.twin_joints, "a joint of the twin",
          "positions in rad or m");
  by_name("twin_below", ConditionKind::kTwinBelow, names.twin_joints, "a joint of the twin",
          "positions in rad or m");
  by_name("turns", ConditionKind::kTurns, names.manipulator, "a manipulator joint",
          "full turns since the start, with sign");
  by_name("gantry_above", ConditionKind::kGantryAbove, names.gantry, "a gantry joint",
          "positions in m");
  by_name("gantry_below", ConditionKind::kGantryBelow, names.gantry, "a gantry joint",
          "positions in m");
  number("elapsed_s", ConditionKind::kElapsed, "time since the device began to run");
  v.group(
      "handle_at",
      [&](auto& child) {
        Condition& at = event.all_of.emplace_back();
        at.kind = ConditionKind::kHandleAt;
        child.number("x_m", at.place.x(), kAnyNumber, "in B", Need::kRequired);
        child.number("y_m", at.place.y(), kAnyNumber, "in B", Need::kRequired);
        child.number("azimuth_rad", at.place.z(), kAnyNumber, "of the hand axis about z of B",
                     Need::kRequired);
      },
      "the handle is nearer than 0.10 m and 15 degrees");
  v.rule(!event.all_of.empty(), "", "an event needs at least one condition");
}

template <class V>
void describe_events(V& v, ScenarioDraft& d) {
  v.list(
      "events",
      [&](auto& child) {
        EventRule& event = d.events.emplace_back();
        child.words("name", event.name, "short, for example t_a", Need::kRequired);
        child.words("what", event.what, "one sentence for people", Need::kRequired);
        child.group(
            "when", [&](auto& conditions) { describe_conditions(conditions, d.names, event); },
            "conditions, all true at the same time", Need::kRequired);
      },
      "expected events: each is looked for once the one before it has happened");
}

}  // namespace hg::config
