#include "hg/config/device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hg/config/device_collision.h"
#include "hg/config/device_schema.h"
#include "hg/config/file_kind.h"
#include "hg/config/loader.h"
#include "hg/config/suspected_unit.h"
#include "hg/config/tool.h"
#include "hg/controller/safety/stopping.h"
#include "hg/core/error.h"
#include "hg/core/index.h"
#include "hg/model/haptic_giant.h"

namespace hg::config {
namespace {

model::ChainOptions chain_options(const DeviceDraft& draft, const std::optional<Tool>& tool) {
  model::ChainOptions options = {.root_link = name_of(draft.link_names, draft.part.root_link),
                                 .tip_link = name_of(draft.link_names, draft.part.tip_link)};
  if (tool && draft.flange >= 0) {
    options.tool = tool->body;
    options.tool->link = name_of(draft.link_names, draft.flange);
  }
  return options;
}

std::optional<model::ChainModel> make_chain(LoaderFile& file, const DeviceDraft& draft,
                                            const std::optional<UrdfText>& urdf,
                                            const model::ChainOptions& options) {
  if (!urdf || !draft.part.is_usable) return no_chain(file);
  return read_chain(file, *urdf, options);
}

std::optional<Tool> read_tool(LoaderFile& file, const DeviceDraft& draft) {
  if (draft.tool.empty()) return {};
  try {
    return load_tool(draft.tool, file.sources);
  } catch (const SetupError& error) {
    file.faults.add_all(error);
    return {};
  }
}

void refuse_couplings(Loader& loader, const model::ChainModel& chain) {
  for (const model::Coupling& coupling : chain.couplings()) {
    loader.rule(false, "urdf", "a device has no joints that mimic others",
                "'" + coupling.joint + "'");
  }
}

void take_joints(const model::ChainModel& chain, DeviceDraft& draft) {
  draft.frame_names = chain.frame_names();
  for (const model::Joint& joint : chain.joints()) {
    draft.joint_names.push_back(joint.name);
    draft.joints.push_back(
        {unit_of(joint.type),
         {.q_min = joint.position.lb, .q_max = joint.position.ub, .dq_max = joint.velocity_max}});
  }
}

// The chain has the gantry first, then the manipulator, and nothing else.
void check_order(Loader& loader, const model::ChainModel& chain, const DeviceDraft& draft) {
  std::vector<int> named = draft.gantry;
  named.insert(named.end(), draft.manipulator.begin(), draft.manipulator.end());
  std::string expected;
  bool is_right = named.size() == chain.joints().size();
  for (std::size_t i = 0; i < chain.joints().size(); ++i) {
    (expected += i > 0 ? ", " : "") += chain.joints()[i].name;
    is_right = is_right && named[i] == static_cast<int>(i);
  }
  loader.rule(
      is_right, "manipulator",
      "gantry and manipulator together must be the joints of the URDF in its order, " + expected);
  loader.rule(draft.gantry.size() <= kMaxGantry, "gantry", "at most 2 joints are possible");
  loader.rule(draft.manipulator.size() <= kMaxManipulator, "manipulator",
              "at most 7 joints are possible");
}

void check_gantry(Loader& loader, const model::ChainModel& chain, const DeviceDraft& draft) {
  for (int i : draft.gantry) {
    const model::Joint& joint = chain.joints()[i];
    loader.rule(joint.nv == 1, "gantry", "a device has no floating joints", "'" + joint.name + "'");
    loader.rule(unit_of(joint.type) == draft.gantry_unit, "gantry",
                "gantry joints must be all prismatic or all revolute", "'" + joint.name + "'");
  }
  const DeviceModel& model = draft.device.model;
  const bool has_posture = model.posture.array().isFinite().any();
  if (model.has_closed_form) {
    loader.rule(draft.gantry.size() == 2 && draft.manipulator.size() == 6 &&
                    draft.gantry_unit == JointUnit::kLength,
                "kinematics",
                "haptic_giant needs two prismatic gantry joints and six manipulator joints");
    loader.rule(!has_posture, "posture", "haptic_giant has the posture of eq. (30)");
    if (model.handle >= 0 && chain.nv() == kMaxGantry + 6) {
      try {
        model::haptic_giant::lengths_of(chain, model.handle);
      } catch (const SetupError& error) {
        loader.rule(false, "kinematics", error.what());
      }
    }
  } else {
    loader.rule(draft.gantry.empty() || loader.is_given("posture"), "gantry",
                "a gantry needs 'posture': without goals of the joints it has nowhere to go");
  }
}

void check_joints(Loader& loader, const model::ChainModel& chain, const DeviceDraft& draft) {
  for (int i : draft.manipulator) {
    loader.rule(chain.joints()[i].nv == 1, "manipulator", "a device has no floating joints",
                "'" + draft.joint_names[i] + "'");
  }
  for (const VirtualJoint& sum : draft.device.model.virtual_joints) {
    for (int i = 0; i < sum.weights.size(); ++i) {
      const int joint = draft.manipulator[i];
      const JointUnit unit = draft.joints[joint].unit;
      loader.rule(sum.weights[i] == 0.0 || unit == JointUnit::kAngle, "virtual_joints",
                  "only revolute joints can be added", "'" + draft.manipulator_names[i] + "'");
    }
  }
  const VectorM& posture = draft.device.model.posture;
  for (int i = 0; i < posture.size(); ++i) {
    const limits::JointLimits& limits = draft.joints[draft.manipulator[i]].limits;
    loader.rule(
        std::isnan(posture[i]) || (limits.q_min <= posture[i] && posture[i] <= limits.q_max),
        "posture", draft.manipulator_names[i] + " must be within the limits of the joint",
        with_suspected_degrees(posture[i], limits, draft.joints[draft.manipulator[i]].unit));
  }
}

// All joints of the manipulator have an actuator, or none.
void check_actuators(LoaderFile& file, const DeviceDraft& draft) {
  const auto is_actuated = [&](int joint) { return draft.joints[joint].actuator.has_value(); };
  for (int i : draft.gantry) {
    if (!is_actuated(i)) continue;
    const std::string item = "actuators." + draft.joint_names[i];
    file.faults.add(file.places.nearest(item), item,
                    "must be a joint of the manipulator: the gantry has 'drive'");
  }
  if (std::ranges::none_of(draft.manipulator, is_actuated)) return;
  for (int i : draft.manipulator) {
    if (is_actuated(i)) continue;
    file.faults.add(
        file.places.nearest("actuators"), "actuators",
        "all joints of the manipulator need one, there is none for '" + draft.joint_names[i] + "'");
  }
}

void check_ratings(LoaderFile& file, const DeviceDraft& draft) {
  for (int i : draft.manipulator) {
    const DeviceJoint& joint = draft.joints[i];
    if (std::isfinite(joint.limits.dq_max) && std::isfinite(joint.limits.ddq_max)) continue;
    const std::string item = "joints." + draft.joint_names[i];
    file.faults.add(file.places.nearest(item), item,
                    "needs " + std::string(kSpeed.of(joint.unit)) + " and " +
                        std::string(kAcceleration.of(joint.unit)));
  }
}

// Of a list of joints that is not usable either spelling of a key counts.
JointUnit gantry_unit(const DeviceDraft& draft) {
  if (!draft.has_joints) return JointUnit::kEither;
  if (draft.gantry.empty()) return JointUnit::kLength;
  return draft.joints[draft.gantry[0]].unit;
}

// Without a usable list of joints every name counts: one fault is enough.
std::vector<std::string> manipulator_names(const DeviceDraft& draft) {
  if (!draft.has_joints) return draft.joint_names;
  std::vector<std::string> names;
  for (int i : draft.manipulator) names.push_back(draft.joint_names[i]);
  return names;
}

// Fills the model of the device from its chain and the parts of the draft.
void take_model(model::ChainModel chain, DeviceDraft& draft) {
  DeviceConfig& device = draft.device;
  DeviceModel& model = device.model;
  model.chain = std::move(chain);
  model.n_p = static_cast<int>(draft.gantry.size());
  model.n_m = static_cast<int>(draft.manipulator.size());
  for (int i : draft.gantry) {
    const limits::JointLimits& axis = draft.joints[i].limits;
    model.gantry_range.push_back({axis.q_min, axis.q_max});
  }
  for (int i : draft.manipulator) {
    model.joint_limits.push_back(draft.joints[i].limits);
    if (draft.joints[i].actuator) model.actuators.push_back(*draft.joints[i].actuator);
  }
}

// Stopping distances that device.yaml does not give, from the ratings.
void state_stopping(DeviceConfig& device) {
  constexpr double kSpare = 1.25;
  safety::MonitorConfig& monitor = device.monitor;
  const double lag = safety::drive_lag(device.model.follows_positions);
  std::array<double, 2> need{};  // of revolute and prismatic joints
  for (std::size_t i = 0; i < device.model.joint_limits.size(); ++i) {
    const limits::JointLimits& joint = device.model.joint_limits[i];
    double& most = need[device.model.is_slide(static_cast<int>(i)) ? 1 : 0];
    most = std::max(most, safety::stopping_need(joint.dq_max, joint.ddq_max, lag).distance);
  }
  const double gantry = safety::stopping_need(device.model.drive).distance;
  const auto state = [](double& distance, double least) {
    if (std::isnan(distance)) distance = least > 0.0 ? kSpare * least : kInfinity;
  };
  state(monitor.stop_distance, need[0]);
  state(monitor.slide_stop_distance, need[1]);
  state(monitor.gantry_stop_distance, gantry);
  state(monitor.turn_stop_distance, gantry);
}

}  // namespace

void settle_law(DeviceConfig& device) {
  device.model.follows_positions = device.control.method == tracking::Method::kDrives;
  device.model.has_torque_limits = !device.model.actuators.empty() &&
                                   device.rendering.law == rendering::Law::kGauss &&
                                   device.rendering.bounds == rendering::Bounds::kRecoverable;
}

void check_rate(const DeviceConfig& device, double rate_Hz) {
  DeviceModel model = device.model;
  model.rate_Hz = rate_Hz;
  check_device_model(model);
  tracking::check_control_config(device.control, rate_Hz);
}

DeviceConfig load_device(const std::filesystem::path& file) {
  SourceReader reader;
  return load_device(file, reader);
}

DeviceConfig load_device(const std::filesystem::path& path, SourceReader& reader) {
  const std::size_t first_source = reader.texts().size();
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  DeviceDraft draft;
  DeviceConfig& device = draft.device;
  std::optional<model::ChainModel> chain;
  std::optional<Tool> tool;
  std::optional<UrdfText> urdf;
  load_file_of_kind(FileKind::kDevice, file, [&](Loader& loader) {
    describe_chain(loader, draft);
    urdf = read_urdf(file, device.urdf);
    if (urdf) draft.link_names = urdf->link_names;
    describe(loader, draft.part, draft.link_names);
    describe_tool(loader, draft);
    tool = read_tool(file, draft);
    device.chain_options = chain_options(draft, tool);
    chain = make_chain(file, draft, urdf, device.chain_options);
    if (chain) refuse_couplings(loader, *chain);
    if (chain) take_joints(*chain, draft);
    describe_structure(loader, draft);
    if (chain && tool && draft.flange >= 0) device.model.handle = chain->frame(tool->body.handle);
    draft.gantry_unit = gantry_unit(draft);
    draft.manipulator_names = manipulator_names(draft);
    describe_limits(loader, draft);
    describe_behaviour(loader, draft);
    describe_control(loader, draft);
    if (!chain || !draft.has_joints) return;
    check_order(loader, *chain, draft);
    check_gantry(loader, *chain, draft);
    check_joints(loader, *chain, draft);
    check_ratings(file, draft);
    check_actuators(file, draft);
  });

  device.model.T_H_S = tool ? tool->T_H_S : pose_of(draft.sensor);
  if (tool) {
    device.monitor.has_dead_man = tool->has_dead_man;
    constexpr auto kDeadMan = index(SafetyInput::kDeadMan);
    if (!tool->has_dead_man) device.start_test.has_input[kDeadMan] = false;
  }
  take_model(std::move(*chain), draft);
  settle_law(device);
  state_stopping(device);
  if (draft.watches_collisions) watch_collisions(*urdf, draft);
  device.sources = reader.since(first_source);
  device.places = std::move(file.places);
  return std::move(device);
}

}  // namespace hg::config
