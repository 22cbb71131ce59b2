#include "hg/design/device_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <utility>

#include "hg/config/changed_text.h"
#include "hg/controller/safety/stopping.h"
#include "hg/core/error.h"
#include "hg/design/design_urdf.h"
#include "hg/model/chain_data.h"

namespace hg::design {
namespace {

using config::ChangedValue;
using model::haptic_giant::Lengths;
using std::numbers::pi;

constexpr double kFasterAtMost = 2.0;  // ratings of accelerations over those of the base
constexpr int kArms = 5;               // links that carry a joint at their end

// [A] handbook 1.4, links m1 to m5 of the reference device: what is neither joint nor tube, and
// where all but the next joint has its centre of mass, as a share of the length
struct Fittings {
  double mass, centre;
};
constexpr std::array<Fittings, kArms> kFittings = {{{3.42, 1.526 / (6.6 * 0.53)},
                                                    {2.08, 1.549 / (6.1 * 0.67)},
                                                    {1.2, 1.0 / 3.0},
                                                    {1.52, 4.0 / 7.0},
                                                    {0.5, 0.0}}};
constexpr double kHandTube = 2.0;   // [A] kg per metre of the hand
constexpr double kHandBack = 0.04;  // m from the handle back to the hand's centre of mass

std::array<double, kArms> arm_lengths(const Lengths& lengths) {
  return {lengths.L1, lengths.L2, lengths.D3, lengths.L4, 0.0};
}

const JointSize& size_of(const Catalogue& catalogue, const DesignVariables& variables, int joint) {
  const int index = variables.size[static_cast<std::size_t>(joint)];
  if (index < 0 || index >= static_cast<int>(catalogue.sizes.size())) {
    throw SetupError(fmt::format("design: joint m{} has size {}, the catalogue has 0 to {}",
                                 joint + 1, index, catalogue.sizes.size() - 1));
  }
  return catalogue.sizes[static_cast<std::size_t>(index)];
}

double ratio_of(const JointSize& size, const DesignVariables& variables, int joint) {
  const int index = variables.ratio[static_cast<std::size_t>(joint)];
  if (index < 0 || index >= static_cast<int>(size.ratios.size())) {
    throw SetupError(fmt::format("design: joint m{} has ratio {}, size {} has 0 to {}", joint + 1,
                                 index, size.name, size.ratios.size() - 1));
  }
  return size.ratios[static_cast<std::size_t>(index)];
}

struct Drives {
  std::array<const JointSize*, kDesignJoints> sizes;
  std::array<double, kDesignJoints> ratios;
  std::array<ActuatorModel, kDesignJoints> actuators;
};

Drives drives_of(const Catalogue& catalogue, const DesignVariables& variables) {
  Drives drives;
  for (int i = 0; i < kDesignJoints; ++i) {
    const auto k = static_cast<std::size_t>(i);
    drives.sizes[k] = &size_of(catalogue, variables, i);
    drives.ratios[k] = ratio_of(*drives.sizes[k], variables, i);
    drives.actuators[k] = with_ratio(*drives.sizes[k], drives.ratios[k]);
  }
  return drives;
}

struct BaseLink {
  double mass, centre, inertia, axial_inertia;
};

// The base's link as written in its URDF: [A] handbook 1.4.
constexpr std::array<BaseLink, kDesignJoints> kBaseLinks = {{{11.6, 0.36, 0.42, 0.045},
                                                             {9.4, 0.40, 0.40, 0.030},
                                                             {7.5, 0.47, 0.38, 0.02},
                                                             {4.8, 0.30, 0.090, 0.010},
                                                             {2.1, 0.05, 0.0050, 0.0030},
                                                             {1.4, 0.08, 0.0035, 0.0012}}};

std::array<DesignLink, 6> links_of(const DesignBase& base, const Catalogue& catalogue,
                                   const DesignVariables& variables, const Drives& drives) {
  std::array<DesignLink, 6> links;
  const std::array<double, kArms> from = arm_lengths(base.variables.lengths);
  const std::array<double, kArms> to = arm_lengths(variables.lengths);
  for (std::size_t i = 0; i < kArms; ++i) {
    const BaseLink& old = kBaseLinks[i];
    const double joint = drives.sizes[i + 1]->mass;
    // the tube suits the joint that carries it; between joints 5 and 6 there is none
    const double rest = kFittings[i].mass + drives.sizes[i]->tube_mass * to[i];
    links[i].mass = joint + rest;
    const double scale = from[i] > 0.0 ? to[i] / from[i] : 1.0;
    links[i].centre = from[i] > 0.0
                          ? (joint * to[i] + rest * kFittings[i].centre * to[i]) / links[i].mass
                          : old.centre;
    links[i].inertia = old.inertia * links[i].mass / old.mass * scale * scale;
    links[i].axial_inertia = old.axial_inertia * links[i].mass / old.mass;
  }
  const BaseLink& hand = kBaseLinks[5];
  const double longer = variables.lengths.D6 - base.variables.lengths.D6;
  links[5] = {.mass = hand.mass + kHandTube * longer,
              .centre = variables.lengths.D6 - kHandBack,
              .inertia = hand.inertia,
              .axial_inertia = hand.axial_inertia};
  const Drives old_drives = drives_of(catalogue, base.variables);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto scale = [&](std::size_t joint) {
      return drives.sizes[joint]->radius / old_drives.sizes[joint]->radius;
    };
    links[i].scale_start = scale(i);
    links[i].scale_end = i + 1 < 6 ? scale(i + 1) : 1.0;
    const limits::JointLimits& limits = base.device.model.joint_limits[i];
    links[i].velocity = limits.dq_max / old_drives.actuators[i].speed_full_torque *
                        drives.actuators[i].speed_full_torque;
    links[i].effort = drives.actuators[i].torque_max;
  }
  return links;
}

// What the peak torques give to each joint alone with the arm stretched, rad/s^2.
std::array<double, kDesignJoints> stretched_accelerations(const DeviceModel& model,
                                                          model::ChainData& chain,
                                                          const Drives& drives) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(8);
  q[3] = model.joint_limits[1].q_min;
  q[5] = 0.5 * pi;
  chain.update(q, Eigen::VectorXd::Zero(8));
  std::array<double, kDesignJoints> values;
  for (int i = 0; i < kDesignJoints; ++i) {
    const ActuatorModel& actuator = drives.actuators[static_cast<std::size_t>(i)];
    const double left = actuator.torque_max - std::abs(chain.gravity()[2 + i]);
    values[static_cast<std::size_t>(i)] =
        std::max(0.0, left) / (chain.M()(2 + i, 2 + i) + actuator.rotor_inertia);
  }
  return values;
}

// The smallest acceleration along x, y or z that the rated joints give `frame`, over postures of
// the gantry's target, m/s^2.
double cartesian_acceleration(const DeviceModel& model, model::ChainData& chain, int frame,
                              const Lengths& lengths,
                              const std::array<double, kDesignJoints>& ddq_max, bool is_flat) {
  double least = kInfinity;
  for (double q1 : {0.0, 0.7, 1.4, 2.1}) {
    for (double q4 : {0.5, 1.2, 2.0}) {
      Eigen::VectorXd q = Eigen::VectorXd::Zero(8);
      q.tail(6) << q1, 0.5 * pi, -std::atan2(lengths.L1, lengths.L2), q4, 1.4 - q4, 0.0;
      chain.update_kinematics(q, Eigen::VectorXd::Zero(8));
      const model::Jacobian& J = chain.jacobian(frame);
      for (int axis = 0; axis < (is_flat ? 2 : 3); ++axis) {
        double sum = 0.0;
        for (int i = 0; i < model.n_m; ++i) {
          sum += std::abs(J(axis, 2 + i)) * ddq_max[static_cast<std::size_t>(i)];
        }
        least = std::min(least, sum);
      }
    }
  }
  return least;
}

// Lowest and highest handle that the limits of m4 and of the sum q4 + q5 allow.
Interval heights(const DeviceModel& model, const Lengths& lengths) {
  const limits::JointLimits& m4 = model.joint_limits[3];
  const limits::JointLimits& sum = model.virtual_joints.at(0).limits;
  const auto height = [&](double q4, double s) {
    return -lengths.D3 - lengths.L4 * std::cos(q4) - lengths.D6 * std::cos(s);
  };
  return {height(m4.q_min, sum.q_min), height(m4.q_max, sum.q_max)};
}

double three_digits(double value) {
  return value > 0.0 ? std::stod(fmt::format("{:.3g}", value)) : 0.0;
}

class Changes {
 public:
  void set(std::string item, double value) {
    const double rounded = std::round(value * 1e9) / 1e9;
    changes_.push_back({std::move(item), fmt::format("{}", rounded)});
  }
  void words(std::string item, std::string value) {
    changes_.push_back({std::move(item), std::move(value)});
  }
  std::string apply(const std::string& text) const { return config::changed_text(text, changes_); }

 private:
  std::vector<ChangedValue> changes_;
};

void set_actuator(Changes& changes, const std::string& joint, const ActuatorModel& actuator) {
  const std::string item = "actuators." + joint + ".";
  changes.set(item + "rotor_inertia_kg_m2", actuator.rotor_inertia);
  changes.set(item + "stiffness_Nm_per_rad", actuator.stiffness);
  changes.set(item + "damping_Nms_per_rad", actuator.damping);
  changes.set(item + "coulomb_friction_Nm", actuator.coulomb_friction);
  changes.set(item + "viscous_friction_Nms_per_rad", actuator.viscous_friction);
  changes.set(item + "load_friction", actuator.load_friction);
  changes.set(item + "stiction", actuator.stiction);
  changes.set(item + "stribeck_rad_per_s", actuator.stribeck_speed);
  changes.set(item + "torque_max_Nm", actuator.torque_max);
  changes.set(item + "torque_rated_Nm", actuator.torque_rated);
  changes.set(item + "full_torque_to_rad_per_s", actuator.speed_full_torque);
  changes.set(item + "no_load_rad_per_s", actuator.speed_no_load);
}

std::string joint_name(int i) { return fmt::format("m{}", i + 1); }

// How the base's URDF changes. The room keeps the base's margins between the gantry's frame, the
// hand's box and the gantry's travel.
UrdfChange change_of(const DesignBase& base, const Catalogue& catalogue,
                     const DesignVariables& variables, const Drives& drives,
                     const std::string& comment) {
  const DeviceModel& old = base.device.model;
  const double wider_x = variables.gantry_x - base.variables.gantry_x;
  const double wider_y = variables.gantry_y - base.variables.gantry_y;
  UrdfChange change = {.from = base.variables.lengths,
                       .to = variables.lengths,
                       .links = links_of(base, catalogue, variables, drives),
                       .wider_x = wider_x,
                       .wider_y = wider_y,
                       .higher = variables.mount_height - base.variables.mount_height,
                       .gantry_end = {old.gantry_range[0].ub + 0.5 * wider_x,
                                      old.gantry_range[1].ub + 0.5 * wider_y},
                       .comment = comment};
  if (change.gantry_end[0] < 0.1 || change.gantry_end[1] < 0.1) {
    throw SetupError(
        fmt::format("design: a gantry of {:.2f} x {:.2f} m is smaller than its margins",
                    variables.gantry_x, variables.gantry_y));
  }
  return change;
}

// Old and new arm with the ratings of their joints.
struct Arms {
  Arms(const DeviceModel& device, const model::ChainModel& chain_model, const Drives& drives,
       const Drives& old_drives)
      : old(device), chain(chain_model), old_chain(device.chain) {
    const auto can = stretched_accelerations(old, chain, drives);
    const auto could = stretched_accelerations(old, old_chain, old_drives);
    for (std::size_t i = 0; i < kDesignJoints; ++i) {
      old_ddq_max[i] = old.joint_limits[i].ddq_max;
      const double most = i < 4 ? kFasterAtMost : 1.0;  // of the wrist the base's is the handbook's
      if (can[i] <= 0.0) {
        throw SetupError(fmt::format("design: joint m{} cannot carry the arm", i + 1));
      }
      ddq_max[i] = three_digits(old_ddq_max[i] * std::min(most, can[i] / could[i]));
    }
  }

  const DeviceModel& old;
  model::ChainData chain, old_chain;
  std::array<double, kDesignJoints> ddq_max, old_ddq_max;
};

void set_joints(const safety::MonitorConfig& monitor, const UrdfChange& change,
                const Drives& drives, const Arms& arms, Changes& device) {
  const DeviceModel& old = arms.old;
  safety::StoppingNeed need, old_need;  // of the slowest joint
  const auto take = [](safety::StoppingNeed& most, const safety::StoppingNeed& one) {
    most = {std::max(most.time, one.time), std::max(most.distance, one.distance)};
  };
  for (int i = 0; i < kDesignJoints; ++i) {
    const auto k = static_cast<std::size_t>(i);
    device.set("joints." + joint_name(i) + ".ddq_max_rad_per_s2", arms.ddq_max[k]);
    set_actuator(device, joint_name(i), drives.actuators[k]);
    take(need, safety::stopping_need(change.links[k].velocity, arms.ddq_max[k], 0.0));
    take(old_need, safety::stopping_need(old.joint_limits[k].dq_max, arms.old_ddq_max[k], 0.0));
  }
  device.set("monitor.stop_distance_rad",
             three_digits(monitor.stop_distance * need.distance / old_need.distance));
  device.set("monitor.stop_time_s",
             three_digits(monitor.stop_time * std::max(1.0, need.time / old_need.time)));
  const limits::JointLimits& sum = old.virtual_joints[0].limits;
  const double faster = (change.links[3].velocity + change.links[4].velocity) /
                        (old.joint_limits[3].dq_max + old.joint_limits[4].dq_max);
  device.set("virtual_joints[0].dq_max_rad_per_s", three_digits(sum.dq_max * faster));
  device.set("virtual_joints[0].ddq_max_rad_per_s2",
             std::min(sum.ddq_max, three_digits(arms.ddq_max[3] + arms.ddq_max[4])));
}

void set_cartesian_limits(const UrdfChange& change, Arms& arms, Changes& device) {
  constexpr double kLowest = 0.02, kHighest = 0.01;  // m; the box ends there, as the base's
  const DeviceModel& old = arms.old;
  for (int k = 0; k < 2; ++k) {
    const CartesianLimit& limit = old.cartesian_limits[static_cast<std::size_t>(k)];
    const std::string item = fmt::format("cartesian_limits[{}].", k);
    for (int axis = 0; axis < 2; ++axis) {
      const double end = limit.axes[static_cast<std::size_t>(axis)].q_max +
                         0.5 * (axis == 0 ? change.wider_x : change.wider_y);
      device.set(item + "xy"[axis] + ".q_min_m", -end);
      device.set(item + "xy"[axis] + ".q_max_m", end);
    }
    const bool is_hand = limit.frame == old.handle;
    if (is_hand) {
      const Interval reach = heights(old, change.to);
      device.set(item + "z.q_min_m", std::ceil((reach.lb + kLowest) * 100.0) / 100.0);
      device.set(item + "z.q_max_m", std::ceil((reach.ub + kHighest) * 100.0) / 100.0);
    }
    const int frame =
        arms.chain.model().frame(old.chain.frame_names()[static_cast<std::size_t>(limit.frame)]);
    const double gives =
        cartesian_acceleration(old, arms.chain, frame, change.to, arms.ddq_max, !is_hand);
    const double gave = cartesian_acceleration(old, arms.old_chain, limit.frame, change.from,
                                               arms.old_ddq_max, !is_hand);
    device.set(item + "ddq_max_m_per_s2",
               three_digits(limit.axes[0].ddq_max * std::min(1.0, gives / gave)));
  }
}

double price_of(const DesignVariables& variables, const Drives& drives,
                const StructurePrices& prices) {
  double price = 0.0;
  for (const JointSize* size : drives.sizes) price += size->price;
  const Lengths& lengths = variables.lengths;
  return price +
         (prices.fixed + prices.gantry_per_m * (variables.gantry_x + variables.gantry_y) +
          prices.tube_per_m * (lengths.L1 + lengths.L2 + lengths.D3 + lengths.L4 + lengths.D6));
}

}  // namespace

void DeviceFiles::write(const std::filesystem::path& folder) const {
  for (const auto& [name, text] : {std::pair{"device.yaml", &device},
                                   {"device.urdf", &urdf},
                                   {"simulation.yaml", &simulation}}) {
    std::ofstream file(folder / name);
    file << *text;
    file.close();
    if (!file) throw SetupError((folder / name).generic_string() + ": cannot be written");
  }
}

DesignBase load_base(const std::filesystem::path& device, const Catalogue& catalogue,
                     const std::array<std::string, kDesignJoints>& sizes,
                     const std::array<double, kDesignJoints>& ratios) {
  config::SourceReader reader;
  DesignBase base = {.device = config::load_device(device, reader)};
  const DeviceModel& model = base.device.model;
  const auto refuse = [&](const char* why) {
    throw SetupError(fmt::format("{}: the base of a design {}", device.generic_string(), why));
  };
  if (!model.has_closed_form) refuse("needs 'kinematics: haptic_giant'");
  if (base.device.simulation_file.empty()) refuse("needs a 'simulation'");
  if (model.actuators.size() != kDesignJoints) refuse("needs 'actuators'");
  if (model.virtual_joints.size() != 1) refuse("needs one virtual joint, q4+q5");
  if (model.cartesian_limits.size() != 2) refuse("needs Cartesian limits of hand and elbow");
  const std::string simulation = reader.read(base.device.simulation_file);
  for (const std::filesystem::path& file : {device, base.device.urdf}) {
    base.texts.push_back({file.generic_string(), reader.read(file)});
  }
  base.texts.push_back({base.device.simulation_file.generic_string(), simulation});

  base.variables.lengths = model::haptic_giant::lengths_of(model.chain, model.handle);
  const model::haptic_giant::Lengths reference;
  const model::haptic_giant::Lengths& lengths = base.variables.lengths;
  if (lengths.L1 != reference.L1 || lengths.L2 != reference.L2 || lengths.D3 != reference.D3 ||
      lengths.L4 != reference.L4 || lengths.D6 != reference.D6) {
    refuse("must have the links of models/haptic_giant, whose masses are known");
  }
  base.variables.mount_height = -base.device.floor_z;
  for (int i = 0; i < kDesignJoints; ++i) {
    const auto k = static_cast<std::size_t>(i);
    base.variables.size[k] = catalogue.size(sizes[k]);
    const std::vector<double>& all =
        catalogue.sizes[static_cast<std::size_t>(base.variables.size[k])].ratios;
    const auto found = std::ranges::find(all, ratios[k]);
    if (found == all.end()) {
      throw SetupError(fmt::format("catalogue: size '{}' has no ratio {:g}", sizes[k], ratios[k]));
    }
    base.variables.ratio[k] = static_cast<int>(found - all.begin());
  }
  return base;
}

DeviceDesign make_device(const DesignBase& base, const Catalogue& catalogue,
                         const DesignVariables& variables, const std::string& name,
                         const StructurePrices& prices, bool watches_collisions) {
  const Drives drives = drives_of(catalogue, variables);
  const std::string origin = fmt::format(
      "{}: written by `hapticgiant design` from the structure of {}", name, base.device.name);
  const UrdfChange change = change_of(base, catalogue, variables, drives, origin);
  DeviceFiles files;
  files.urdf = changed_urdf(base.texts[1].content, change);

  const model::ChainModel chain = model::ChainModel::from_urdf_text(files.urdf, "device.urdf");
  Arms arms(base.device.model, chain, drives, drives_of(catalogue, base.variables));
  Changes device;
  device.words("name", fmt::format("\"{}\"", name));
  device.words("urdf", "device.urdf");
  device.words("simulation", "simulation.yaml");
  device.set("floor_z_m", -variables.mount_height);
  if (!watches_collisions) device.words("collision.is_watched", "false");
  set_joints(base.device.monitor, change, drives, arms, device);
  set_cartesian_limits(change, arms, device);
  files.device = "# " + origin + ".\n" + device.apply(base.texts[0].content);

  Changes simulation;
  for (int i = 0; i < kDesignJoints; ++i) {
    simulation.set("gear_ratio." + joint_name(i), drives.ratios[static_cast<std::size_t>(i)]);
  }
  files.simulation = "# " + origin + ".\n" + simulation.apply(base.texts[2].content);

  config::SourceReader texts({{"device.yaml", files.device},
                              {"device.urdf", files.urdf},
                              {"simulation.yaml", files.simulation}});
  DeviceDesign design = {.files = std::move(files),
                         .device = config::load_device("device.yaml", texts),
                         .price = price_of(variables, drives, prices)};
  for (const DesignLink& link : change.links) design.moving_mass += link.mass;
  return design;
}

}  // namespace hg::design
