#include "hg/check/device_inspection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hg/check/cartesian_rule.h"
#include "hg/check/collision_inspection.h"
#include "hg/check/ignored_urdf.h"
#include "hg/check/stopping_rule.h"
#include "hg/check/twin_bodies.h"
#include "hg/check/unit_comparison.h"
#include "hg/check/unit_inspection.h"
#include "hg/check/wall_force.h"
#include "hg/core/linear_algebra.h"
#include "hg/core/unit_doubt.h"
#include "hg/model/chain_data.h"
#include "hg/model/urdf.h"
#include "hg/workspace/postures.h"
#include "hg/workspace/workspace.h"

namespace hg::check {
namespace {

std::string position_key(const model::Joint& joint, const char* end) {
  return fmt::format("joints.{}.q_{}_{}", joint.name, end, joint.is_slide() ? "m" : "rad");
}

void inspect_synchronisation(const config::DeviceConfig& device, Collector& out) {
  const double dt = device.model.dt();
  const auto inspect_pair = [&](double kP, double kD, const char* tag) {
    const std::string key_P = fmt::format("synchronisation.kP_{}_1_per_s2", tag);
    const std::string key_D = fmt::format("synchronisation.kD_{}_1_per_s", tag);
    if (kD * dt >= 2.0) {
      out.add(Severity::kFault, key_D,
              fmt::format("kD dt = {:.3g} at {:g} Hz, must be below 2: the handle would run away "
                          "from the twin",
                          kD * dt, device.model.rate_Hz),
              fmt::format("lower it below {:g}, or raise rate_Hz", 2.0 / dt));
      return;
    }
    const double pole = synchronisation_pole(kP, kD, dt);
    if (pole >= 1.0) {
      out.add(
          Severity::kFault, key_P,
          fmt::format("with kD {:g} and {:g} Hz the slowest pole of eq. (11) is {:.4f}, must be "
                      "below 1",
                      kD, device.model.rate_Hz, pole),
          fmt::format("lower it: {:g} damps critically with this kD", 0.25 * kD * kD));
    } else if (kD < std::sqrt(kP)) {
      out.add(Severity::kWarning, key_D,
              fmt::format("the damping ratio kD / (2 sqrt(kP)) is {:.2f}, expected at least 0.5: "
                          "the handle swings about the twin",
                          0.5 * kD / std::sqrt(kP)),
              "raise it to " + rounded_up(2.0 * std::sqrt(kP), 3));
    }
  };
  inspect_pair(device.rendering.kP_tran, device.rendering.kD_tran, "tran");
  inspect_pair(device.rendering.kP_rot, device.rendering.kD_rot, "rot");
}

void inspect_gantry(const config::DeviceConfig& device, Collector& out) {
  if (device.model.n_p == 0) return;
  const double k_max = 1.0 / (4.0 * device.model.drive.lag);
  const double k_unstable = 1.0 / (device.model.drive.lag + device.model.drive.dead_time);
  const double k = device.prepositioning.k_ppu;
  if (k < k_max) return;
  out.add(k < k_unstable ? Severity::kWarning : Severity::kFault, "prepositioning.k_ppu_1_per_s",
          fmt::format("{:g} 1/s, must be below 1 / (4 lag) = {:.3g}: the gantry overshoots{}", k,
                      k_max, k < k_unstable ? "" : " and oscillates"),
          fmt::format("lower it to {}, or give the drive's true lag in drive.lag_s",
                      rounded_down(0.7 * k_max, 2)));
}

void inspect_joints(const config::DeviceConfig& device, const workspace::Survey& survey,
                    Collector& out) {
  const DeviceModel& model = device.model;
  for (std::size_t i = 0; i < model.chain.joints().size(); ++i) {
    const model::Joint& joint = model.chain.joints()[i];
    const bool is_gantry = static_cast<int>(i) < model.n_p;
    if (!is_gantry) {
      const auto& limits = model.joint_limits[i - model.n_p];
      if (limits.q_min >= limits.q_max) {
        out.add(Severity::kFault, position_key(joint, "max"),
                fmt::format("the joint has no range, it may only be at {:g}", limits.q_max),
                "give q_min and q_max some distance, or make the joint fixed in the URDF");
      }
    }
    if (!std::isfinite(joint.effort_max)) {
      out.add_at_urdf(Severity::kWarning, "joint", joint.name,
                      "has no torque rating: the datasheet cannot say what forces it bears",
                      "give <limit effort=\"...\"/> in Nm, or N for a prismatic joint");
    } else if (survey.gravity_max.size() > static_cast<Eigen::Index>(i) &&
               survey.gravity_max[i] > joint.effort_max) {
      out.add_at_urdf(Severity::kFault, "joint", joint.name,
                      fmt::format("needs {:.3g} to hold the device itself, its rating is {:g}{}",
                                  survey.gravity_max[i], joint.effort_max,
                                  doubt_of_weight(survey.gravity_max[i], joint.effort_max)),
                      "give the true effort and masses, or limit the joints to postures it bears");
    }
  }
}

void inspect_virtual_joints(const config::DeviceConfig& device, Collector& out) {
  const DeviceModel& model = device.model;
  for (std::size_t k = 0; k < model.virtual_joints.size(); ++k) {
    const VirtualJoint& joint = model.virtual_joints[k];
    const std::string item = fmt::format("virtual_joints[{}]", k);
    Interval reach = {0.0, 0.0};
    double ddq_sum = 0.0;
    for (int i = 0; i < model.n_m; ++i) {
      const double weight = joint.weights[i];
      if (weight == 0.0) continue;
      const auto& limits = model.joint_limits[i];
      reach.lb += std::min(weight * limits.q_min, weight * limits.q_max);
      reach.ub += std::max(weight * limits.q_min, weight * limits.q_max);
      ddq_sum += std::abs(weight) * limits.ddq_max;
    }
    if (intersect(reach, {joint.limits.q_min, joint.limits.q_max}).empty()) {
      out.add(Severity::kFault, item,
              fmt::format("allows {:g} .. {:g}, but its joints only reach {:g} .. {:g}",
                          joint.limits.q_min, joint.limits.q_max, reach.lb, reach.ub),
              "the two ranges must overlap: check signs of weights and the joint limits");
    } else if (joint.limits.q_min < reach.lb && joint.limits.q_max > reach.ub) {
      out.add(Severity::kNote, item,
              fmt::format("never acts: its joints only reach {:g} .. {:g}", reach.lb, reach.ub),
              "remove it, or narrow its range");
    }
    if (joint.limits.ddq_max > ddq_sum) {
      out.add(Severity::kWarning, item + ".ddq_max_rad_per_s2",
              fmt::format("{:g}, but its joints together reach {:g}: it cannot brake in time",
                          joint.limits.ddq_max, ddq_sum),
              "lower it to " + rounded_down(ddq_sum, 3));
    }
  }
}

void inspect_boxes(const config::DeviceConfig& device, const workspace::Survey& survey,
                   Collector& out) {
  constexpr double kFixed = 1e-6;  // m; a coordinate that varies less is constant
  const DeviceModel& model = device.model;
  for (std::size_t k = 0; k < survey.cloud.frames.size(); ++k) {
    if (survey.cloud.frames[k].isEmpty()) continue;  // no posture was found at all
    const CartesianLimit& limit = model.cartesian_limits[k];
    for (int axis = 0; axis < 3; ++axis) {
      const limits::JointLimits& range = limit.axes[axis];
      const double lowest = survey.cloud.frames[k].min()[axis],
                   highest = survey.cloud.frames[k].max()[axis];
      if (!std::isfinite(range.q_min) && !std::isfinite(range.q_max)) continue;
      const std::string item = fmt::format("cartesian_limits[{}].{}", k, "xyz"[axis]);
      const bool is_fixed = highest - lowest < kFixed;
      if (lowest > range.q_max || highest < range.q_min) {
        out.add(Severity::kFault, item,
                is_fixed ? fmt::format("{:g} .. {:g} m does not contain {:.3f} m, where this frame "
                                       "always is",
                                       range.q_min, range.q_max, lowest)
                         : fmt::format("no posture brings the frame into {:g} .. {:g} m, it "
                                       "reaches {:.2f} .. {:.2f} m",
                                       range.q_min, range.q_max, lowest, highest),
                is_fixed ? "remove this axis, or include that coordinate"
                         : "the axes are those of the root link: check signs and units");
      } else if (is_fixed) {
        out.add(Severity::kNote, item,
                fmt::format("never acts: the frame is always at {:.3f} m", lowest),
                "remove this axis");
      }
    }
  }
}

std::ptrdiff_t faults_of(const Collector& out) {
  return std::ranges::count(out.findings, Severity::kFault, &Finding::severity);
}

// Sums of joints and boxes that are possible one by one may leave no room together.
void inspect_room(const config::DeviceConfig& device, const workspace::Survey& survey,
                  Collector& out) {
  const std::ptrdiff_t faults_before = faults_of(out);
  inspect_virtual_joints(device, out);
  inspect_boxes(device, survey, out);
  if (!survey.postures.empty() || faults_of(out) > faults_before) return;
  if (survey.drawn == 0) {
    out.add(Severity::kFault, "virtual_joints",
            "no posture within the joint limits was found that satisfies all of them",
            "together they leave no room: widen their ranges, or check the signs of the weights");
  } else {
    out.add(Severity::kFault, "cartesian_limits",
            fmt::format("none of {} postures within the joint limits satisfies all limits",
                        survey.drawn),
            "the boxes leave no room: widen them, or check the joint limits");
  }
}

std::string posture_text(const config::DeviceConfig& device, const Eigen::VectorXd& q) {
  std::string text;
  for (int i = 0; i < device.model.n_m; ++i) {
    text += fmt::format("{}{} {:.2f}", i > 0 ? ", " : "", device.model.manipulator_joint(i),
                        q[device.model.n_p + i]);
  }
  return text;
}

// Masses that a joint and the fixed joints beyond it carry.
double mass_beyond(const model::Urdf& urdf, int link) {
  double mass = urdf.links[link].inertial ? urdf.links[link].inertial->mass : 0.0;
  for (const model::UrdfJoint& joint : urdf.joints) {
    if (joint.parent == link && joint.type == model::UrdfJointType::kFixed)
      mass += mass_beyond(urdf, joint.child);
  }
  return mass;
}

// What the hand holds is on the last link.
void inspect_last_link(const config::DeviceConfig& device, Collector& out) {
  constexpr double kMost = 50.0;  // kg; a person moves no more
  const std::string& last = device.model.chain.joints().back().name;
  for (const model::Urdf& urdf : urdfs_among(device.sources)) {
    const auto joint = std::ranges::find(urdf.joints, last, &model::UrdfJoint::name);
    if (joint == urdf.joints.end()) continue;
    const double mass = mass_beyond(urdf, joint->child);
    if (mass <= kMost) continue;
    const std::string grams = suspected_unit(mass, {0.0, kMost}, kOtherMasses, "kg");
    out.add_at_urdf(
        Severity::kWarning, "link", urdf.links[joint->child].name,
        fmt::format("{:.4g} kg beyond the last joint, where a person holds it, are more "
                    "than a person moves{}",
                    mass, after_semicolon(grams)),
        "give <mass> in kg");
  }
}

// The value near which a posture is singular wherever the other joints are; none: it takes several
// joints.
std::optional<workspace::SingularValue> singular_value_at(const config::DeviceConfig& device,
                                                          const Eigen::VectorXd& q) {
  constexpr double kNear = 0.05;  // rad
  const DeviceModel& model = device.model;
  const workspace::JointRanges reached = workspace::joint_ranges(device);
  std::vector<Interval> ranges;
  for (int i = 0; i < model.chain.nv(); ++i) ranges.push_back({reached.lower[i], reached.upper[i]});
  std::optional<workspace::SingularValue> nearest;
  double distance = kNear;
  for (const workspace::SingularValue& singular :
       workspace::singular_values(model.chain, model.handle, model.n_p, ranges)) {
    const double value = q[singular.joint] + (singular.other < 0 ? 0.0 : q[singular.other]);
    if (std::abs(value - singular.value) > distance) continue;
    distance = std::abs(value - singular.value);
    nearest = singular;
  }
  return nearest;
}

// "the handle cannot move along (0.00, 1.00, 0.00)": the direction in which `J` moves it least.
std::string lost_direction(const model::Jacobian& J, double length) {
  Eigen::MatrixXd scaled = J;
  scaled.bottomRows<3>() *= length;
  const Eigen::VectorXd lost = symmetric_eigen(scaled * scaled.transpose()).vectors.col(0);
  const bool turns = lost.tail<3>().norm() > lost.head<3>().norm();
  const Eigen::Vector3d along = (turns ? lost.tail<3>() : lost.head<3>()).normalized();
  return fmt::format("the handle cannot {} ({:.2f}, {:.2f}, {:.2f})",
                     turns ? "turn about" : "move along", along.x(), along.y(), along.z());
}

// Joints of a manipulator of six that move together there while the handle stands still.
std::vector<std::string> joints_of_self_motion(const DeviceModel& model, const model::Jacobian& J) {
  constexpr double kShare = 0.3;  // of the joint that moves most
  const Eigen::VectorXd motion = symmetric_eigen(J.transpose() * J).vectors.col(0).cwiseAbs();
  std::vector<std::string> names;
  for (int i = 0; i < model.n_m; ++i) {
    if (motion[i] > kShare * motion.maxCoeff()) names.push_back(model.manipulator_joint(i));
  }
  return names;
}

// What a posture that takes several joints is like.
std::string posture_of_several(const DeviceModel& model, const workspace::Survey& survey) {
  model::ChainData chain(model.chain);
  chain.update_kinematics(survey.most_singular.q, Eigen::VectorXd::Zero(model.chain.nv()));
  const model::Jacobian J = workspace::manipulator_jacobian(model, chain, model.handle);
  std::string text = lost_direction(J, survey.length);
  if (model.n_m > 6) return text;
  return text + fmt::format(", and {} can move without it",
                            fmt::join(joints_of_self_motion(model, J), ", "));
}

void inspect_singularities(const config::DeviceConfig& device, const workspace::Survey& survey,
                           Collector& out) {
  constexpr double kSingular = 5e-3;  // of the scaled Jacobian: 1 rad/s at the handle takes 200
  if (survey.postures.empty()) return;
  const workspace::Posture& worst = survey.most_singular;
  if (worst.conditioning.smallest >= kSingular) return;
  const DeviceModel& model = device.model;
  const auto name = [&](int joint) { return model.chain.joints()[joint].name; };
  const std::string posture = fmt::format(
      "{} (smallest singular value {:.2g}, expected at least {:g}): near it the handle "
      "cannot follow the twin",
      posture_text(device, worst.q), worst.conditioning.smallest, kSingular);
  if (const auto singular = singular_value_at(device, worst.q); !singular) {
    out.add(Severity::kWarning, "manipulator",
            fmt::format("the limits do not exclude a singular posture, {}", posture),
            fmt::format("no joint alone makes it: there {}; keep the handle away from there by "
                        "cartesian_limits",
                        posture_of_several(model, survey)));
  } else if (singular->other < 0) {
    out.add(Severity::kWarning, "joints." + name(singular->joint),
            fmt::format("the arm is singular wherever {} is at {:.2f}, which the limits do not "
                        "exclude: {}",
                        name(singular->joint), singular->value, posture),
            "keep it to one side of this value, 0.2 away, by q_min or q_max");
  } else {
    out.add(Severity::kWarning, "joints." + name(singular->other),
            fmt::format("the arm is singular wherever {} + {} is {:.2f}, which the limits do not "
                        "exclude: {}",
                        name(singular->joint), name(singular->other), singular->value, posture),
            "keep this sum to one side of the value, 0.2 away, by virtual_joints");
  }
}

}  // namespace

double synchronisation_pole(double kP, double kD, double dt) {
  const double trace = 2.0 - 0.5 * kP * dt * dt - kD * dt;
  const double determinant = 1.0 - kD * dt + 0.5 * kP * dt * dt;
  const std::complex<double> root = std::sqrt(std::complex(0.25 * trace * trace - determinant));
  return std::max(std::abs(0.5 * trace + root), std::abs(0.5 * trace - root));
}

Findings inspect(const config::DeviceConfig& device, const workspace::Survey& survey) {
  Collector out(device.sources, device.places);
  inspect_synchronisation(device, out);
  inspect_gantry(device, out);
  inspect_joints(device, survey, out);
  inspect_room(device, survey, out);
  inspect_cartesian_rule(device, survey, out);
  inspect_wall_forces(device, out);
  inspect_stopping(device, out);
  inspect_singularities(device, survey, out);
  inspect_collisions(device, out);
  inspect_bodies(device.sources, joint_names(device.model.chain), out);
  inspect_last_link(device, out);
  inspect_units(device.sources, joint_names(device.model.chain), out);
  compare_units(device, survey, out);
  inspect_ignored(device.sources, UrdfUse::kDevice, out);
  inspect_floor(device, survey, out);
  return std::move(out.findings);
}

}  // namespace hg::check
