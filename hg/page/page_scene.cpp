#include "hg/page/page_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>

#include "hg/config/law_names.h"
#include "hg/config/shipped_files.h"
#include "hg/controller/safety/rules.h"
#include "hg/model/urdf_parts.h"
#include "hg/scenario/names.h"
#include "hg/scenario/recorded/robot_models.h"
#include "hg/scenario/start_posture.h"
#include "hg/viewer_server/message.h"
#include "hg/workspace/workspace.h"

namespace hg::page {
namespace {

namespace fs = std::filesystem;
using viewer_server::Choice;
using viewer_server::Environment;

viewer_server::SceneJoint scene_joint(const model::Joint& joint) {
  using viewer_server::JointType;
  viewer_server::SceneJoint scene{.name = joint.name, .range = joint.position};
  scene.dq_max = joint.velocity_max;
  switch (joint.type) {
    case model::JointType::kRevolute:
    case model::JointType::kContinuous:
      break;
    case model::JointType::kPrismatic:
      scene.type = JointType::kPrismatic;
      break;
    case model::JointType::kFloating:
      scene.type = JointType::kFloating;
      return scene;
  }
  scene.planar = joint.planar;
  scene.axis = joint.axis;
  return scene;
}

void add_limits(const limits::JointLimits& limits, viewer_server::SceneJoint& joint) {
  joint.range = {limits.q_min, limits.q_max};
  joint.dq_max = limits.dq_max;
}

viewer_server::SceneChain device_chain(const config::DeviceConfig& device) {
  viewer_server::SceneChain chain;
  chain.name = device.name;
  chain.urdf = device.urdf;
  for (const model::Joint& joint : device.model.chain.joints()) {
    chain.joints.push_back(scene_joint(joint));
  }
  for (std::size_t i = 0; i < device.model.joint_limits.size(); ++i) {
    viewer_server::SceneJoint& joint = chain.joints[device.model.n_p + i];
    add_limits(device.model.joint_limits[i], joint);
    if (i < device.model.actuators.size()) {
      joint.tau_max = device.model.actuators[i].torque_max;
    }
  }
  return chain;
}

// The URDF of a twin with joints that are coupled by its YAML file; empty: as it is.
std::string drawn_urdf(const config::Twin& twin) {
  if (twin.model.chain.couplings().empty()) return "";
  const auto source =
      std::ranges::find(twin.sources, twin.urdf.string(), &config::SourceText::name);
  if (source == twin.sources.end()) return "";
  return model::with_mimics(source->content, twin.model.chain.couplings());
}

std::vector<viewer_server::SceneFollower> followers_of(const model::ChainModel& chain) {
  constexpr int kValues = 129;
  std::vector<viewer_server::SceneFollower> followers;
  for (const model::Coupling& coupling : chain.couplings()) {
    if (!coupling.curve) continue;
    viewer_server::SceneFollower follower = {coupling.joint, coupling.leader, {}, false, {}};
    follower.range = coupling.curve->range();
    follower.is_periodic = !follower.range.bounded();
    if (follower.is_periodic) follower.range = {-M_PI, M_PI};
    const auto& [lb, ub] = follower.range;
    for (int i = 0; i < kValues; ++i) {
      follower.values.push_back(coupling.curve->at(lb + i * (ub - lb) / (kValues - 1)).value);
    }
    followers.push_back(std::move(follower));
  }
  return followers;
}

viewer_server::SceneChain twin_chain(const config::Twin& twin) {
  viewer_server::SceneChain chain;
  chain.name = twin.name;
  chain.urdf = twin.urdf;
  chain.urdf_text = drawn_urdf(twin);
  chain.T_B_root = twin.T_B_root;
  chain.followers = followers_of(twin.model.chain);
  for (const model::Joint& joint : twin.model.chain.joints()) {
    chain.joints.push_back(scene_joint(joint));
    const rendering::TwinDof& dof = twin.model.dofs[joint.v_index];
    if (dof.q_index >= 0) add_limits(dof.limits, chain.joints.back());
  }
  return chain;
}

// where the handle may be; on axes without limits the page shows 4 m around its start
Eigen::AlignedBox3d box_of(const config::Scenario& scenario) {
  constexpr double kHalf = 2.0;  // m
  const Eigen::Vector3d p = scenario::handle_start(scenario.twin.model).p;
  Eigen::AlignedBox3d box = workspace::handle_box(scenario.device.model);
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(box.min()[axis])) box.min()[axis] = p[axis] - kHalf;
    if (!std::isfinite(box.max()[axis])) box.max()[axis] = p[axis] + kHalf;
  }
  return box;
}

viewer_server::SceneSurface scene_surface(const surfaces::Surface& surface) {
  using viewer_server::SurfaceShape;
  viewer_server::SceneSurface scene{.name = surface.name, .pose = surface.pose};
  if (const auto* box = std::get_if<surfaces::Box>(&surface.shape)) {
    scene.shape = SurfaceShape::kBox;
    scene.size = box->size;
  } else if (const auto* sphere = std::get_if<surfaces::Sphere>(&surface.shape)) {
    scene.shape = SurfaceShape::kSphere;
    scene.size.setConstant(2.0 * sphere->radius);
  } else if (const auto* cylinder = std::get_if<surfaces::Cylinder>(&surface.shape)) {
    scene.shape = SurfaceShape::kCylinder;
    scene.size << 2.0 * cylinder->radius, 2.0 * cylinder->radius, cylinder->length;
  } else if (const auto* mesh = std::get_if<surfaces::Mesh>(&surface.shape)) {
    scene.shape = SurfaceShape::kMesh;
    for (const surfaces::Triangle& triangle : mesh->triangles()) {
      for (const Eigen::Vector3d& corner : triangle.corners) {
        scene.triangles.insert(scene.triangles.end(), corner.begin(), corner.end());
      }
    }
  }
  return scene;
}

// The shapes of the device itself: the page has the floor already.
std::vector<viewer_server::SceneShape> scene_shapes(const config::DeviceConfig& device) {
  std::vector<viewer_server::SceneShape> shapes;
  for (const collision::Shape& shape : device.collision.shapes) {
    if (shape.is_surrounding) continue;
    shapes.push_back({.name = shape.name,
                      .link = device.model.chain.frame_names()[shape.frame],
                      .pose = shape.T_frame_shape,
                      .radius = shape.radius,
                      .length = 2.0 * shape.half_length,
                      .size = 2.0 * shape.half_edges});
  }
  return shapes;
}

Environment environment_of(config::Surroundings surroundings) {
  switch (surroundings) {
    case config::Surroundings::kRoom:
      return Environment::kRoom;
    case config::Surroundings::kDoor:
      return Environment::kDoor;
    case config::Surroundings::kExcavator:
      return Environment::kExcavator;
  }
  return Environment::kRoom;
}

// Where the remote machine is drawn: turned as the hand leads it, and beside the twin, where it
// hides neither the hand nor the device.
Pose remote_place(const config::Scenario& scenario) {
  constexpr double kTwinAway = 2.3;  // m, between two machines of the size of a twin
  constexpr double kToolAway = 0.7;  // m, between the hand and the range of a tool
  const teleoperation::TeleoperationConfig& config = *scenario.teleoperation;
  if (config.mapping == teleoperation::Mapping::kJoints) {
    Pose place = scenario.twin.T_B_root;
    place.p += kTwinAway * place.R.col(1);
    return place;
  }
  const Pose hand = scenario::handle_start(scenario.twin.model);
  const Eigen::Vector3d to_user = hand.R.col(2);
  const Eigen::Vector3d away = Eigen::Vector3d(-to_user.x(), -to_user.y(), 0.0).normalized();
  double reach = 0.0;
  for (const teleoperation::AxisLimits& axis : config.limiter.axes) {
    reach = std::max({reach, axis.range.ub, -axis.range.lb});
  }
  Pose place;
  place.R = config.R_R_B.transpose();
  place.p = hand.p + (kToolAway + std::min(reach, 1.0)) * away;
  return place;
}

// Empty: nothing is simulated of it.
std::string link_text(const teleoperation::ChannelConfig& link) {
  if (link.delay + link.jitter + link.loss == 0.0) return {};
  std::string text = fmt::format("{:g} ms each way", 1e3 * link.delay);
  if (link.jitter > 0.0) text += fmt::format(", up to {:g} ms more", 1e3 * link.jitter);
  if (link.loss > 0.0) text += fmt::format(", {:g} % lost", 100.0 * link.loss);
  return text;
}

std::optional<viewer_server::SceneTeleoperation> scene_teleoperation(
    const config::Scenario& scenario) {
  if (!scenario.teleoperation) return {};
  const teleoperation::TeleoperationConfig& config = *scenario.teleoperation;
  const bool is_tool = config.mapping != teleoperation::Mapping::kJoints;
  viewer_server::SceneTeleoperation scene;
  scene.mapping =
      is_tool ? viewer_server::RemoteMapping::kTool : viewer_server::RemoteMapping::kJoints;
  scene.method = viewer_server::word_of(config.method.kind);
  scene.link = link_text(config.link);
  scene.force_scale = config.force_scale;
  scene.T_B_root = remote_place(scenario);
  const std::size_t count = is_tool ? 3 : config.limiter.axes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = is_tool ? std::string(1, "xyz"[i]) : scenario.twin.model.dofs[i].name;
    scene.axes.push_back({name, config.limiter.axes[i].range});
  }
  for (const teleoperation::Wall& wall : config.machine.walls) {
    scene.walls.push_back({{wall.normal.begin(), wall.normal.end()}, wall.offset});
  }
  return scene;
}

// "Free space" of free_space
std::string title_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

void sort(std::vector<Choice>& choices) {
  std::sort(choices.begin(), choices.end(),
            [](const Choice& a, const Choice& b) { return a.name < b.name; });
}

constexpr char kOwnFiles[] = "Files here";

// "Franka FR3" of the arm fr3; "HapticGiant" of what is of no arm.
std::string device_of(const std::string& name, const std::vector<config::ShippedFile>& devices) {
  const std::string arm = fs::path(name).parent_path().generic_string();
  const auto device = std::ranges::find(devices, arm.empty() ? devices.front().name : arm,
                                        &config::ShippedFile::name);
  return device == devices.end() ? arm : device->title;
}

std::vector<Choice> choices_of(const std::vector<config::ShippedFile>& shipped,
                               const std::vector<config::ShippedFile>& own,
                               const std::vector<config::ShippedFile>& devices) {
  std::vector<Choice> choices;
  for (const config::ShippedFile& file : shipped) {
    const std::string device = devices.empty() ? "" : device_of(file.name, devices);
    choices.push_back({file.name, scenario::without_device(title_of(file.title), device), device});
  }
  for (const config::ShippedFile& file : own) {
    choices.push_back({file.name, fmt::format("{} ({})", title_of(file.title), file.name),
                       devices.empty() ? "" : kOwnFiles});
  }
  return choices;
}

std::vector<Choice> choices_of_people() {
  std::vector<Choice> people;
  for (const auto& entry : fs::directory_iterator(config::models_root() / "models" / "scripts")) {
    if (entry.path().extension() != ".yaml") continue;
    people.push_back({entry.path().generic_string(), "Script " + entry.path().stem().string(), ""});
  }
  sort(people);
  people.insert(
      people.begin(),
      {{"", "as in the scenario", ""}, {"mouse", "Only the mouse", ""}, {"none", "No person", ""}});
  return people;
}

std::vector<Choice> choices_of_surfaces(const std::vector<Choice>& scenarios) {
  std::vector<Choice> sets = {{"", "as in the scenario", ""}, {"none", "No surfaces", ""}};
  for (const Choice& scenario : scenarios) {
    if (!config::has_surfaces(config::find_scenario(scenario.name))) continue;
    sets.push_back({scenario.name, "Those of: " + scenario.title, ""});
  }
  return sets;
}

// adds a choice given on the command line
void add_own(const std::string& name, std::vector<Choice>& choices) {
  if (is_choice(choices, name)) return;
  const bool has_groups =
      std::ranges::any_of(choices, [](const Choice& choice) { return !choice.group.empty(); });
  choices.push_back({name, fs::path(name).filename().string(), has_groups ? "As given" : ""});
}

std::string stopping_text(const config::DeviceConfig& device) {
  const safety::MonitorConfig& stated = device.monitor;
  bool has_turns = false, has_slides = false;
  for (int i = 0; i < device.model.n_m; ++i) {
    (device.model.is_slide(i) ? has_slides : has_turns) = true;
  }
  std::string text = fmt::format("A stop takes at most {:g} s", stated.stop_time);
  if (has_turns) text += fmt::format(", {:g} rad of a joint", stated.stop_distance);
  if (has_slides) text += fmt::format(", {:g} m of a sliding joint", stated.slide_stop_distance);
  if (device.model.n_p > 0) {
    text += device.model.is_gantry_slide()
                ? fmt::format(", {:g} m of the gantry", stated.gantry_stop_distance)
                : fmt::format(", {:g} rad of the gantry", stated.turn_stop_distance);
  }
  return text + "; brakes close at 90 % of these distances.";
}

}  // namespace

viewer_server::Scene page_scene(const config::Scenario& scenario) {
  viewer_server::Scene scene;
  scene.title = scenario.title;
  scene.description = scenario.description;
  scene.device = device_chain(scenario.device);
  scene.twin = twin_chain(scenario.twin);
  scene.twin_base_moves = scenario.twin_motion.has_value();
  scene.twin.live_text = scenario::twin_description(scenario);
  scene.gantry_joints = scenario.device.model.n_p;
  scene.limits = scenario.limits;
  scene.rate_hz = scenario.device.model.rate_Hz;
  scene.box = box_of(scenario);
  scene.floor_z = scenario.device.floor_z;
  scene.hand_stiffness = scenario.script.hand.stiffness;
  scene.hand_force_max = scenario.script.hand.force_max;
  scene.stopping = stopping_text(scenario.device);
  scene.environment = environment_of(scenario.twin.surroundings);
  for (const surfaces::Surface& surface : scenario.surfaces) {
    scene.surfaces.push_back(scene_surface(surface));
  }
  scene.shapes = scene_shapes(scenario.device);
  scene.teleoperation = scene_teleoperation(scenario);
  for (const EventRule& event : scenario.events) {
    for (const Condition& condition : event.all_of) {
      if (condition.kind != ConditionKind::kHandleAt) continue;
      const Eigen::Vector3d& at = condition.place;
      scene.checkpoints.push_back({event.name, at.x(), at.y(), at.z()});
    }
  }
  return scene;
}

viewer_server::Choices page_choices(const scenario::ScenarioOptions& options,
                                    const scenario::ScenarioOptions& given) {
  const std::vector<config::ShippedFile> devices = config::shipped_devices();
  const Choice as_in_scenario = {"", "as in the scenario", ""};
  viewer_server::Choices choices;
  const config::LocalFiles own_files = config::local_files();
  choices.scenarios = choices_of(config::shipped_scenarios(), own_files.scenarios, devices);
  choices.twins = choices_of(config::shipped_twins(), own_files.twins, devices);
  choices.devices = choices_of(devices, own_files.devices, {});
  choices.people = choices_of_people();
  for (const auto& law : config::kLawPresets) {
    choices.laws.push_back({std::string(law.name), title_of(std::string(law.name)), ""});
  }
  choices.twins.insert(choices.twins.begin(), as_in_scenario);
  choices.devices.insert(choices.devices.begin(), as_in_scenario);
  for (const scenario::ScenarioOptions* own : {&given, &options}) {
    add_own(own->scenario, choices.scenarios);
    add_own(own->twin, choices.twins);
    add_own(own->device, choices.devices);
    add_own(own->user, choices.people);
  }
  choices.surface_sets = choices_of_surfaces(choices.scenarios);
  for (const scenario::ScenarioOptions* own : {&given, &options}) {
    add_own(own->surfaces, choices.surface_sets);
  }
  choices.scenario = options.scenario;
  choices.twin = options.twin;
  choices.device = options.device;
  choices.surfaces = options.surfaces;
  choices.person = options.user;
  return choices;
}

bool is_choice(const std::vector<Choice>& choices, const std::string& name) {
  return std::any_of(choices.begin(), choices.end(),
                     [&](const Choice& choice) { return choice.name == name; });
}

std::vector<viewer_server::Setting> page_settings(const std::vector<config::FormField>& form) {
  std::vector<viewer_server::Setting> settings;
  for (const config::FormField& field : form) {
    settings.push_back({field.name, field.group, field.label, field.unit, field.min, field.max,
                        field.value, field.step, field.help});
  }
  return settings;
}

std::optional<viewer_server::TeleoperationView> teleoperation_view(const config::Scenario& scenario,
                                                                   const Sample& sample) {
  if (!scenario.teleoperation) return {};
  return viewer_server::TeleoperationView{sample.teleoperation,
                                          sample.operator_input.is_clutch_open};
}

viewer_server::SafetyView safety_view(const Sample& sample, const analysis::Names& names) {
  const CycleRecord& record = sample.record;
  const auto text_of = [&](const Fault& fault) -> std::string {
    if (fault.code == FaultCode::kNone) return {};
    const std::string figures = analysis::figures_of(fault, names, sample.sensors);
    return fmt::format("{} {}{}", static_cast<int>(fault.code), fault_words(fault.code).meaning,
                       figures.empty() ? "" : " (" + figures + ")");
  };
  const bool is_stopped = record.fault.code != FaultCode::kNone;
  return {.cause = text_of(record.fault),
          .release = is_stopped ? std::string(safety::rule_of(record.fault.code).release) : "",
          .warning = text_of(record.warning),
          .panel = sample.operator_input.panel};
}

}  // namespace hg::page
