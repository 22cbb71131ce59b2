#include "apps/hapticgiant/run_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "apps/hapticgiant/paths.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/model/haptic_giant.h"
#include "hg/rendering/catalogue.h"

namespace hg::apps {
namespace {

// two limits of one name could not be told apart
void check_names(const LimitCatalogue& catalogue) {
  std::set<std::string> names;
  for (const LimitInfo& limit : catalogue) {
    if (!names.insert(limit.name).second) {
      throw SetupError("device and twin together must not use a name twice, got '" + limit.name +
                       "'");
    }
  }
}

// what --device, --twin and --user change; expected events belong to the scenario as it stands
void apply(const RunArguments& arguments, config::Scenario& scenario) {
  const auto add_sources = [&](const std::vector<config::SourceText>& sources) {
    scenario.sources.insert(scenario.sources.end(), sources.begin(), sources.end());
  };
  if (!arguments.device.empty()) {
    scenario.device = config::load_device(arguments.device);
    add_sources(scenario.device.sources);
  }
  if (!arguments.twin.empty()) {
    scenario.twin = config::load_twin(arguments.twin);
    scenario.title = scenario.twin.name;
    add_sources(scenario.twin.sources);
  }
  if (!arguments.twin.empty() || !arguments.device.empty()) {
    scenario.limits = rendering::make_catalogue(scenario.device.model, scenario.twin.model);
    check_names(scenario.limits);
    scenario.events.clear();
  }
  if (!arguments.user.empty()) scenario.events.clear();

  if (arguments.user == "mouse") {
    scenario.person = user::PersonKind::kMouse;
  } else if (arguments.user == "none") {
    scenario.person = user::PersonKind::kNone;
  } else if (!arguments.user.empty()) {
    scenario.person = user::PersonKind::kScript;
    scenario.script = config::load_script(arguments.user, scenario.twin.model);
    add_sources(scenario.script.sources);
  } else if (!arguments.twin.empty()) {
    scenario.person = user::PersonKind::kMouse;  // a script is made for one twin
  }
}

struct Start {
  Pose T_B_H;
  Eigen::Vector2d q_p;
  Vector6 q_m;
};

Pose handle_start(const rendering::TwinModel& twin) {
  model::Chain chain = twin.chain;
  chain.update_kinematics(twin.q_start, VectorA::Zero(chain.nv()));
  return chain.pose(twin.end_effector);
}

// throws SetupError when the device may not be at `start`
void check_limits(const config::Scenario& scenario, const Start& start) {
  const rendering::DeviceModel& device = scenario.device.model;
  const auto require = [&](const std::string& item, double value,
                           const limits::JointLimits& limits) {
    if (value >= limits.q_min && value <= limits.q_max) return;
    throw SetupError(fmt::format(
        "twin {}: at its start {} of the device would be at {:.3f}, outside {:.3f} .. {:.3f}; move "
        "or turn the twin's placement",
        scenario.twin.name, item, value, limits.q_min, limits.q_max));
  };
  for (int i = 0; i < 6; ++i) {
    require("joint " + device.manipulator_joint(i), start.q_m[i],
            device.joint_limits[static_cast<std::size_t>(i)]);
  }
  for (const rendering::VirtualJoint& joint : device.virtual_joints) {
    require(joint.name, joint.weights.dot(start.q_m), joint.limits);
  }

  model::Chain chain = device.chain;
  Eigen::Matrix<double, 8, 1> q;
  q << start.q_p, start.q_m;
  chain.update_kinematics(q, Eigen::Matrix<double, 8, 1>::Zero());
  for (const rendering::CartesianLimit& limit : device.cartesian_limits) {
    const Eigen::Vector3d p = chain.pose(limit.frame).p;
    for (int axis = 0; axis < 3; ++axis) {
      require(limit.name + " " + "xyz"[axis], p[axis], limit.axes[static_cast<std::size_t>(axis)]);
    }
  }
}

// the device, in its best posture, with the handle where the twin's end effector starts
Start start_of(const config::Scenario& scenario) {
  Start start;
  start.T_B_H = handle_start(scenario.twin.model);
  const auto require_solved = [&](model::haptic_giant::InverseStatus status, const char* what) {
    if (status == model::haptic_giant::InverseStatus::kSolved) return;
    const Eigen::Vector3d& p = start.T_B_H.p;
    throw SetupError(
        fmt::format("twin {}: {} its handle at ({:.2f}, {:.2f}, {:.2f}) m: {}; move the "
                    "twin's placement",
                    scenario.twin.name, what, p.x(), p.y(), p.z(), to_string(status)));
  };
  require_solved(model::haptic_giant::inverse_at_target(start.T_B_H, start.q_p, start.q_m),
                 "the device cannot reach");
  for (int i = 0; i < 2; ++i) {
    const Interval range = scenario.device.prepositioning.q_limits[static_cast<std::size_t>(i)];
    start.q_p[i] = std::clamp(start.q_p[i], range.lb, range.ub);
  }
  require_solved(model::haptic_giant::inverse(start.T_B_H, start.q_p, {}, start.q_m),
                 "the gantry's reach ends before");
  check_limits(scenario, start);
  return start;
}

// channels that the script leaves open begin where the handle is
void fill_in_start(const config::Scenario& scenario, const Start& start, user::Script& script) {
  std::array<double, user::kPoseChannels> pose{};
  switch (script.frame) {
    case user::ScriptFrame::kBase:
      pose = {start.T_B_H.p.x(),
              start.T_B_H.p.y(),
              start.T_B_H.p.z(),
              model::haptic_giant::nearest_turn(start.q_m.head<3>().sum() + M_PI, 0.0),
              start.q_m[3] + start.q_m[4],
              start.q_m[5]};
      break;
    case user::ScriptFrame::kCylindrical: {
      const Eigen::Vector3d p = (inverse(scenario.twin.T_B_root) * start.T_B_H).p;
      pose = {std::atan2(p.y(), p.x()), std::hypot(p.x(), p.y()), p.z()};
      break;
    }
    case user::ScriptFrame::kTwinJoints: {
      const ConfigurationA& q = scenario.twin.model.q_start;
      std::copy_n(q.data(), std::min<Eigen::Index>(q.size(), user::kPoseChannels), pose.begin());
      break;
    }
  }
  for (std::size_t i = 0; i < pose.size(); ++i) {
    if (!scenario.script.start_given[i]) script.start[i] = pose[i];
  }
}

std::vector<std::string> joint_names(const rendering::DeviceModel& device, int first, int count) {
  std::vector<std::string> names;
  for (int i = first; i < first + count; ++i) {
    names.push_back(device.chain.joints()[static_cast<std::size_t>(i)].name);
  }
  return names;
}

viewer_server::SceneJoint scene_joint(const model::Joint& joint) {
  using viewer_server::JointType;
  switch (joint.type) {
    case model::JointType::kRevolute:
    case model::JointType::kContinuous:
      return {joint.name, JointType::kRevolute};
    case model::JointType::kPrismatic:
      return {joint.name, JointType::kPrismatic};
    case model::JointType::kFloating:
      return {joint.name, JointType::kFloating};
  }
  return {joint.name, JointType::kRevolute};
}

std::string recording_name(const std::filesystem::path& scenario) {
  constexpr std::string_view kMarks = "._-";
  std::string name = scenario.stem().string();
  for (char& c : name) {
    const bool is_plain =
        (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (!is_plain && kMarks.find(c) == std::string_view::npos) c = '_';
  }
  return name;
}

// the options that change what the scenario says, one per line
std::string changes(const RunArguments& arguments) {
  std::string text;
  const auto line = [&](const char* option, const std::string& value) {
    if (!value.empty()) text += fmt::format("{} {}\n", option, value);
  };
  line("--device", arguments.device);
  line("--twin", arguments.twin);
  line("--user", arguments.user);
  if (arguments.rate_Hz) line("--rate-hz", fmt::format("{}", *arguments.rate_Hz));
  return text;
}

// where the handle may be; on axes without limits the page shows 4 m around its start
Eigen::AlignedBox3d box_of(const config::Scenario& scenario) {
  constexpr double kHalf = 2.0;  // m
  const Eigen::Vector3d p = handle_start(scenario.twin.model).p;
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(-kInfinity);
  Eigen::Vector3d upper = Eigen::Vector3d::Constant(kInfinity);
  for (const rendering::CartesianLimit& limit : scenario.device.model.cartesian_limits) {
    if (limit.frame != scenario.device.model.handle) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const limits::JointLimits& range = limit.axes[static_cast<std::size_t>(axis)];
      lower[axis] = std::max(lower[axis], range.q_min);
      upper[axis] = std::min(upper[axis], range.q_max);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(lower[axis])) lower[axis] = p[axis] - kHalf;
    if (!std::isfinite(upper[axis])) upper[axis] = p[axis] + kHalf;
  }
  return {lower, upper};
}

}  // namespace

config::Scenario make_scenario(const RunArguments& arguments) {
  config::Scenario scenario = config::load_scenario(find_scenario(arguments.scenario));
  apply(arguments, scenario);
  if (arguments.rate_Hz) config::set_rate(scenario.device, *arguments.rate_Hz);
  return scenario;
}

cycle::Cycle make_cycle(const config::Scenario& scenario) {
  const config::Device& device = scenario.device;
  return cycle::Cycle({.estimation = device.estimation,
                       .prepositioning = device.prepositioning,
                       .rendering = device.rendering,
                       .monitor = device.monitor},
                      device.model, scenario.twin.model);
}

device::SimulatedDevice make_simulated_device(const config::Scenario& scenario) {
  const config::Device& device = scenario.device;
  const Start start = start_of(scenario);
  user::Config person{scenario.person, scenario.script.hand, scenario.script.script};
  if (scenario.person == user::PersonKind::kScript) fill_in_start(scenario, start, person.script);

  const simulation::Config config{.dt = device.rendering.dt,
                                  .drive = device.drive,
                                  .T_H_S = device.T_H_S,
                                  .q_m_start = start.q_m,
                                  .q_p_start = start.q_p};
  return device::SimulatedDevice(simulation::Simulation(
      config, device.model.chain, device.model.handle,
      user::Person(person, scenario.twin.model.chain, scenario.twin.model.end_effector,
                   scenario.twin.T_B_root)));
}

double planned_duration_s(const config::Scenario& scenario) {
  if (scenario.person != user::PersonKind::kScript) return 0.0;
  return std::max(scenario.duration_s, scenario.script.script.duration_s);
}

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments) {
  const rendering::DeviceModel& device = scenario.device.model;
  recording::RecordingInfo info;
  info.folder = arguments.recordings;
  info.name = recording_name(arguments.scenario);
  info.gantry_joints = joint_names(device, 0, device.n_p);
  info.manipulator_joints = joint_names(device, device.n_p, device.n_m);
  for (const model::Joint& joint : scenario.twin.model.chain.joints()) {
    info.twin_joints.push_back({joint.name, joint.type == model::JointType::kFloating});
  }
  info.limits = scenario.limits;
  for (const auto& source : scenario.sources) {
    info.configuration.push_back({source.name, source.content});
  }
  if (const std::string options = changes(arguments); !options.empty()) {
    info.configuration.push_back({"arguments", options});
  }
  info.version = kVersion;
  info.rate_Hz = scenario.device.rate_Hz;
  return info;
}

viewer_server::Scene viewer_scene(const config::Scenario& scenario) {
  viewer_server::Scene scene;
  scene.title = scenario.title;
  scene.device.urdf = scenario.device.urdf;
  for (const model::Joint& joint : scenario.device.model.chain.joints()) {
    scene.device.joints.push_back(scene_joint(joint));
  }
  scene.twin.urdf = scenario.twin.urdf;
  scene.twin.T_B_root = scenario.twin.T_B_root;
  for (const model::Joint& joint : scenario.twin.model.chain.joints()) {
    scene.twin.joints.push_back(scene_joint(joint));
  }
  scene.limits = scenario.limits;
  scene.rate_hz = scenario.device.rate_Hz;
  scene.box = box_of(scenario);
  return scene;
}

}  // namespace hg::apps
