#include "apps/hapticgiant/run_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/hapticgiant/paths.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/model/haptic_giant.h"
#include "hg/rendering/catalogue.h"

namespace hg::apps {
namespace {

void set_rate(config::Device& device, double rate_Hz) {
  device.rate_Hz = rate_Hz;
  device.rendering.dt = device.estimation.dt = 1.0 / rate_Hz;
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

// the device, in its best posture, with the handle where the twin's end effector starts
Start start_of(const config::Scenario& scenario) {
  const rendering::TwinModel& twin = scenario.twin.model;
  model::Chain chain = twin.chain;
  chain.update_kinematics(twin.q_start, VectorA::Zero(chain.nv()));
  Start start;
  start.T_B_H = chain.pose(twin.end_effector);

  const auto status = model::haptic_giant::inverse_at_target(start.T_B_H, start.q_p, start.q_m);
  const Eigen::Vector3d& p = start.T_B_H.p;
  if (status != model::haptic_giant::InverseStatus::kSolved) {
    throw SetupError(fmt::format(
        "twin {}: the device cannot reach its handle at ({:.2f}, {:.2f}, {:.2f}) m: {}; move the "
        "twin's placement",
        scenario.twin.name, p.x(), p.y(), p.z(), to_string(status)));
  }
  for (int i = 0; i < 6; ++i) {
    const auto& limits = scenario.device.model.joint_limits[static_cast<std::size_t>(i)];
    if (start.q_m[i] < limits.q_min || start.q_m[i] > limits.q_max) {
      throw SetupError(fmt::format(
          "twin {}: at its start joint {} of the device would be at {:.3f} rad, outside {:.3f} .. "
          "{:.3f}; move or turn the twin's placement",
          scenario.twin.name, scenario.device.model.manipulator_joint(i), start.q_m[i],
          limits.q_min, limits.q_max));
    }
  }
  for (int i = 0; i < 2; ++i) {
    const Interval range = scenario.device.prepositioning.q_limits[static_cast<std::size_t>(i)];
    start.q_p[i] = std::clamp(start.q_p[i], range.lb, range.ub);
  }
  const auto at_limit = model::haptic_giant::inverse(start.T_B_H, start.q_p, {}, start.q_m);
  if (at_limit != model::haptic_giant::InverseStatus::kSolved) {
    throw SetupError(
        fmt::format("twin {}: its handle at ({:.2f}, {:.2f}, {:.2f}) m is out of the "
                    "gantry's reach; move the twin's placement",
                    scenario.twin.name, p.x(), p.y(), p.z()));
  }
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

}  // namespace

config::Scenario make_scenario(const RunArguments& arguments) {
  config::Scenario scenario = config::load_scenario(find_scenario(arguments.scenario));
  apply(arguments, scenario);
  if (arguments.rate_Hz) set_rate(scenario.device, *arguments.rate_Hz);
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
  info.name = std::filesystem::path(arguments.scenario).stem().string();
  info.gantry_joints = joint_names(device, 0, device.n_p);
  info.manipulator_joints = joint_names(device, device.n_p, device.n_m);
  for (const model::Joint& joint : scenario.twin.model.chain.joints()) {
    info.twin_joints.push_back({joint.name, joint.type == model::JointType::kFloating});
  }
  info.limits = scenario.limits;
  for (const auto& source : scenario.sources) {
    info.configuration.push_back({source.name, source.content});
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
  for (const rendering::CartesianLimit& limit : scenario.device.model.cartesian_limits) {
    if (limit.frame != scenario.device.model.handle) continue;
    for (int axis = 0; axis < 3; ++axis) {
      scene.box.min()[axis] = limit.axes[static_cast<std::size_t>(axis)].q_min;
      scene.box.max()[axis] = limit.axes[static_cast<std::size_t>(axis)].q_max;
    }
  }
  return scene;
}

}  // namespace hg::apps
