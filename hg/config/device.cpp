#include "hg/config/device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hg/config/device_schema.h"
#include "hg/config/loader.h"
#include "hg/config/tool.h"
#include "hg/controller/safety/stopping.h"
#include "hg/core/error.h"
#include "hg/model/urdf_parts.h"

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
    file.faults.add_complete(error.what());
    return {};
  }
}

void take_joints(const model::ChainModel& chain, DeviceDraft& draft) {
  draft.frame_names = chain.frame_names();
  for (const model::Joint& joint : chain.joints()) {
    draft.joint_names.push_back(joint.name);
    draft.actuators.emplace_back();
    draft.joints.push_back(
        {joint.name,
         unit_of(joint.type),
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
    const model::Joint& joint = chain.joints()[static_cast<std::size_t>(i)];
    loader.rule(joint.nv == 1, "gantry", "a device has no floating joints", "'" + joint.name + "'");
    loader.rule(unit_of(joint.type) == draft.gantry_unit, "gantry",
                "gantry joints must be all prismatic or all revolute", "'" + joint.name + "'");
  }
  const bool has_posture = draft.posture.array().isFinite().any();
  if (draft.kinematics == Kinematics::kHapticGiant) {
    loader.rule(draft.gantry.size() == 2 && draft.manipulator.size() == 6 &&
                    draft.gantry_unit == JointUnit::kLength,
                "kinematics",
                "haptic_giant needs two prismatic gantry joints and six manipulator joints");
    loader.rule(!has_posture, "posture", "haptic_giant has the posture of eq. (30)");
  } else {
    loader.rule(draft.gantry.empty() || loader.is_given("posture"), "gantry",
                "a gantry needs 'posture': without goals of the joints it has nowhere to go");
  }
}

void check_joints(Loader& loader, const model::ChainModel& chain, const DeviceDraft& draft) {
  for (int i : draft.manipulator) {
    const DeviceJoint& joint = draft.joints[static_cast<std::size_t>(i)];
    loader.rule(chain.joints()[static_cast<std::size_t>(i)].nv == 1, "manipulator",
                "a device has no floating joints", "'" + joint.name + "'");
  }
  for (const rendering::VirtualJoint& sum : draft.virtual_joints) {
    for (int i = 0; i < sum.weights.size(); ++i) {
      const int joint = draft.manipulator[static_cast<std::size_t>(i)];
      const JointUnit unit = draft.joints[static_cast<std::size_t>(joint)].unit;
      loader.rule(sum.weights[i] == 0.0 || unit == JointUnit::kAngle, "virtual_joints",
                  "only revolute joints can be added",
                  "'" + draft.manipulator_names[static_cast<std::size_t>(i)] + "'");
    }
  }
  for (int i = 0; i < draft.posture.size(); ++i) {
    const auto named = static_cast<std::size_t>(i);
    const limits::JointLimits& limits =
        draft.joints[static_cast<std::size_t>(draft.manipulator[named])].limits;
    loader.rule(std::isnan(draft.posture[i]) ||
                    (limits.q_min <= draft.posture[i] && draft.posture[i] <= limits.q_max),
                "posture",
                draft.manipulator_names[named] + " must be within the limits of the joint",
                model::to_text(draft.posture[i]));
  }
}

// All joints of the manipulator have an actuator, or none.
void check_actuators(LoaderFile& file, const DeviceDraft& draft) {
  const auto is_actuated = [&](int joint) {
    return draft.actuators[static_cast<std::size_t>(joint)].has_value();
  };
  for (int i : draft.gantry) {
    if (!is_actuated(i)) continue;
    const std::string item = "actuators." + draft.joint_names[static_cast<std::size_t>(i)];
    file.faults.add(file.places.nearest(item), item,
                    "must be a joint of the manipulator: the gantry has 'drive'");
  }
  if (std::ranges::none_of(draft.manipulator, is_actuated)) return;
  for (int i : draft.manipulator) {
    if (is_actuated(i)) continue;
    file.faults.add(file.places.nearest("actuators"), "actuators",
                    "all joints of the manipulator need one, there is none for '" +
                        draft.joint_names[static_cast<std::size_t>(i)] + "'");
  }
}

// names for the simulation file; empty ones are not checked
SimulatedDevice simulated_device(const DeviceDraft& draft, const model::ChainOptions& options) {
  SimulatedDevice device = {
      .handle = name_of(draft.frame_names, draft.handle), .chain = options, .urdf = draft.urdf};
  if (!draft.has_joints) return device;
  for (int i : draft.gantry) {
    device.gantry.push_back(draft.joint_names[static_cast<std::size_t>(i)]);
  }
  device.manipulator = draft.manipulator_names;
  return device;
}

std::optional<Simulation> read_simulation(LoaderFile& file, const SimulatedDevice& device,
                                          const std::filesystem::path& path) {
  try {
    return load_simulation(path, file.sources, device);
  } catch (const SetupError& error) {
    file.faults.add_complete(error.what());
    return {};
  }
}

void check_ratings(LoaderFile& file, const DeviceDraft& draft) {
  for (int i : draft.manipulator) {
    const DeviceJoint& joint = draft.joints[static_cast<std::size_t>(i)];
    if (std::isfinite(joint.limits.dq_max) && std::isfinite(joint.limits.ddq_max)) continue;
    const std::string item = "joints." + joint.name;
    file.faults.add(file.places.nearest(item), item,
                    "needs " + std::string(kSpeed.of(joint.unit)) + " and " +
                        std::string(kAcceleration.of(joint.unit)));
  }
}

// Of a list of joints that is not usable either spelling of a key counts.
JointUnit gantry_unit(const DeviceDraft& draft) {
  if (!draft.has_joints) return JointUnit::kEither;
  if (draft.gantry.empty()) return JointUnit::kLength;
  return draft.joints[static_cast<std::size_t>(draft.gantry[0])].unit;
}

// Without a usable list of joints every name counts: one fault is enough.
std::vector<std::string> manipulator_names(const DeviceDraft& draft) {
  if (!draft.has_joints) return draft.joint_names;
  std::vector<std::string> names;
  for (int i : draft.manipulator) names.push_back(draft.joint_names[static_cast<std::size_t>(i)]);
  return names;
}

rendering::DeviceModel make_model(model::ChainModel chain, const DeviceDraft& draft) {
  rendering::DeviceModel model = {.chain = std::move(chain),
                                  .n_p = static_cast<int>(draft.gantry.size()),
                                  .n_m = static_cast<int>(draft.manipulator.size()),
                                  .handle = draft.handle,
                                  .elbow = draft.elbow,
                                  .joint_limits = {},
                                  .virtual_joints = draft.virtual_joints,
                                  .cartesian_limits = draft.cartesian_limits,
                                  .posture = draft.posture};
  for (int i : draft.manipulator) {
    model.joint_limits.push_back(draft.joints[static_cast<std::size_t>(i)].limits);
  }
  return model;
}

Simulation ideal_simulation(const DeviceDraft& draft) {
  Simulation simulation;
  simulation.sensors = simulator::ideal_sensors();
  simulation.gear_ratio = per_joint(draft.manipulator.size(), 1.0);
  return simulation;
}

// Stopping distances that device.yaml does not give, from the ratings.
void state_stopping(Device& device) {
  constexpr double kSpare = 1.25;
  safety::MonitorConfig& monitor = device.monitor;
  std::array<double, 2> need{};  // of revolute and prismatic joints
  for (std::size_t i = 0; i < device.model.joint_limits.size(); ++i) {
    const limits::JointLimits& joint = device.model.joint_limits[i];
    double& most = need[monitor.is_slide[i] ? 1 : 0];
    most = std::max(most, safety::stopping_need(joint.dq_max, joint.ddq_max).distance);
  }
  const double gantry = safety::stopping_need(device.drive).distance;
  const auto state = [](double& distance, double least) {
    if (std::isnan(distance)) distance = least > 0.0 ? kSpare * least : kInfinity;
  };
  state(monitor.stop_distance, need[0]);
  state(monitor.slide_stop_distance, need[1]);
  state(monitor.gantry_stop_distance, gantry);
  state(monitor.turn_stop_distance, gantry);
}

// Fills the collision model from the collision elements of the URDF.
void watch_collisions(const UrdfText& urdf, const model::ChainOptions& options,
                      const DeviceDraft& draft, Device& device) {
  const model::ChainModel& chain = device.model.chain;
  collision::Geometry geometry = collision::read_geometry(
      model::serial_part(model::read_urdf_text(urdf.text, urdf.file.generic_string()),
                         options.root_link, options.tip_link),
      chain);
  device.unknown_links = std::move(geometry.links_without);
  if (options.tool) device.unknown_links.push_back(options.tool->handle);
  if (geometry.shapes.empty()) return;

  collision::Config& collision = device.collision;
  collision.shapes = std::move(geometry.shapes);
  if (draft.has_floor) collision.shapes.push_back(collision::floor_at(device.floor_z));
  std::vector<Interval> range(device.prepositioning.q_limits.begin(),
                              device.prepositioning.q_limits.begin() + device.model.n_p);
  for (const limits::JointLimits& joint : device.model.joint_limits) {
    range.push_back({joint.q_min, joint.q_max});
  }
  collision.pairs = collision::choose_pairs(collision.shapes, chain, range,
                                            collision.safe_distance + collision::kFarEnough);
}

// Sets what the collision guard assumes of reaction and deceleration of each joint.
void set_reaction(Device& device, double dt) {
  constexpr double kDrive = 0.010;  // s, [HANDBOOK] 6.4
  const int n_p = device.model.n_p;
  const int n = n_p + device.model.n_m;
  collision::Config& collision = device.collision;
  collision.reaction = VectorPM::Constant(n, 2.0 * dt + kDrive);
  collision.deceleration.resize(n);
  for (int i = 0; i < n; ++i) {
    if (i < n_p) {
      collision.reaction[i] = 2.0 * dt + device.drive.dead_time + device.drive.lag;
      collision.deceleration[i] = device.prepositioning.drive.ddq_max;
    } else {
      collision.deceleration[i] =
          device.model.joint_limits[static_cast<std::size_t>(i - n_p)].ddq_max;
    }
  }
}

// What follows from other values: periods, the drive in all its roles, monitored ranges.
void derive(Device& device, const DeviceDraft& draft) {
  if (device.control.method != tracking::Method::kDrives) {
    for (int i : draft.manipulator) {
      device.control.actuators.push_back(*draft.actuators[static_cast<std::size_t>(i)]);
    }
  }
  device.estimation.drive = device.drive;
  device.estimation.T_H_S = device.T_H_S;

  device.prepositioning.n_p = device.model.n_p;
  device.prepositioning.has_closed_form = device.kinematics == Kinematics::kHapticGiant;
  for (std::size_t i = 0; i < draft.gantry.size(); ++i) {
    const limits::JointLimits& axis =
        draft.joints[static_cast<std::size_t>(draft.gantry[i])].limits;
    device.prepositioning.q_limits[i] = {axis.q_min, axis.q_max};
  }

  device.monitor.gantry_speed_max = device.prepositioning.dq_max;
  device.monitor.drive = device.drive;
  device.monitor.is_gantry_slide = draft.gantry_unit != JointUnit::kAngle;
  for (std::size_t i = 0; i < draft.gantry.size(); ++i) {
    device.monitor.gantry_range.push_back(device.prepositioning.q_limits[i]);
  }
  device.monitor.actuators = device.control.actuators;
  for (int i : draft.manipulator) {
    device.monitor.is_slide.push_back(draft.joints[static_cast<std::size_t>(i)].unit ==
                                      JointUnit::kLength);
  }
  for (const limits::JointLimits& joint : device.model.joint_limits) {
    device.monitor.joint_range.push_back({joint.q_min, joint.q_max});
    device.monitor.joint_speed_max.push_back(joint.dq_max);
    device.monitor.joint_acceleration.push_back(joint.ddq_max);
  }
  state_stopping(device);
  settle_law(device);
  set_rate(device, device.rate_Hz);
}

}  // namespace

void settle_law(Device& device) {
  const bool knows_torques = device.control.method != tracking::Method::kDrives &&
                             device.rendering.law == rendering::Law::kGauss &&
                             device.rendering.bounds == rendering::Bounds::kRecoverable;
  rendering::DeviceModel& model = device.model;
  model.motors = knows_torques ? device.control.actuators : std::vector<ActuatorModel>{};
  device.monitor.first_cartesian =
      model.n_m + static_cast<int>(model.virtual_joints.size() + model.motors.size());
  device.monitor.end_cartesian = model.limit_count();
}

void set_rate(Device& device, double rate_Hz) {
  const double dt = 1.0 / rate_Hz;
  if (std::lround(device.drive.dead_time / dt) > CommandDelay::kMaxPeriods) {
    throw SetupError("drive.dead_time_s: at most " + std::to_string(CommandDelay::kMaxPeriods) +
                     " periods, got " + model::to_text(device.drive.dead_time) + " s at " +
                     model::to_text(rate_Hz) + " Hz");
  }
  tracking::Config control = device.control;
  control.dt = dt;
  tracking::check(control);
  device.rate_Hz = rate_Hz;
  device.rendering.dt = dt;
  device.estimation.dt = dt;
  device.control.dt = dt;
  device.prepositioning.drive.tau = device.drive.dead_time + device.drive.lag + dt;
  device.passivity.dt = dt;
  set_reaction(device, dt);
}

void take_simulation(Device& device, const std::filesystem::path& file, SourceReader& reader) {
  const std::size_t first_source = reader.texts().size();
  device.simulation = load_simulation(file, reader, device.simulated);
  const std::vector<SourceText> sources = reader.since(first_source);
  device.sources.insert(device.sources.end(), sources.begin(), sources.end());
}

Device load_device(const std::filesystem::path& file) {
  SourceReader reader;
  return load_device(file, reader);
}

Device load_device(const std::filesystem::path& path, SourceReader& reader) {
  const std::size_t first_source = reader.texts().size();
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  DeviceDraft draft;
  std::optional<model::ChainModel> chain;
  std::optional<Tool> tool;
  std::optional<UrdfText> urdf;
  model::ChainOptions options;
  std::optional<Simulation> simulation;
  load_file(file, [&](Loader& loader) {
    describe_chain(loader, draft);
    urdf = read_urdf(file, draft.urdf);
    if (urdf) draft.link_names = urdf->link_names;
    describe(loader, draft.part, draft.link_names);
    describe_tool(loader, draft);
    tool = read_tool(file, draft);
    options = chain_options(draft, tool);
    chain = make_chain(file, draft, urdf, options);
    if (chain) take_joints(*chain, draft);
    describe_structure(loader, draft);
    if (chain && tool && draft.flange >= 0) draft.handle = chain->frame(tool->body.handle);
    draft.gantry_unit = gantry_unit(draft);
    draft.manipulator_names = manipulator_names(draft);
    describe_limits(loader, draft);
    describe_behaviour(loader, draft);
    describe_control(loader, draft);
    if (!draft.simulation.empty()) {
      simulation = read_simulation(file, simulated_device(draft, options), draft.simulation);
    }
    if (!chain || !draft.has_joints) return;
    check_order(loader, *chain, draft);
    check_gantry(loader, *chain, draft);
    check_joints(loader, *chain, draft);
    check_ratings(file, draft);
    check_actuators(file, draft);
  });

  Device device = {.name = draft.name,
                   .urdf = draft.urdf,
                   .rate_Hz = draft.rate_Hz,
                   .floor_z = draft.floor_z,
                   .has_floor = draft.has_floor,
                   .kinematics = draft.kinematics,
                   .drive = draft.drive,
                   .control = draft.control,
                   .T_H_S = pose_of(draft.sensor),
                   .model = make_model(std::move(*chain), draft),
                   .rendering = draft.rendering,
                   .prepositioning = draft.prepositioning,
                   .estimation = draft.estimation,
                   .monitor = draft.monitor,
                   .sanitiser = draft.sanitiser,
                   .passivity = draft.passivity,
                   .compliance = draft.compliance,
                   .start_test = draft.start_test,
                   .collision = {.safe_distance = draft.safe_distance},
                   .unknown_links = {},
                   .simulation = simulation.value_or(ideal_simulation(draft)),
                   .simulated = simulated_device(draft, options),
                   .sources = reader.since(first_source),
                   .places = std::move(file.places)};
  if (tool) {
    device.T_H_S = tool->T_H_S;
    device.monitor.has_dead_man = tool->has_dead_man;
    constexpr auto kDeadMan = static_cast<std::size_t>(SafetyInput::kDeadMan);
    if (!tool->has_dead_man) device.start_test.has_input[kDeadMan] = false;
  }
  derive(device, draft);
  if (draft.watches_collisions) watch_collisions(*urdf, options, draft, device);
  return device;
}

}  // namespace hg::config
