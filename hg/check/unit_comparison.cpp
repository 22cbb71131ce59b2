#include "hg/check/unit_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/config/schema.h"
#include "hg/core/unit_doubt.h"

namespace hg::check {
namespace {

constexpr double kMostEffort = 100.0;  // times gravity's torque; arms have 2 to 20
constexpr double kMostFelt = 500.0;    // kg, by a person
constexpr double kUsualEffort = 30.0;
constexpr double kQuickest = 0.02;        // s, from rest to full speed; arms take 0.1 s and more
constexpr double kFaster = 5.0;           // times the speed of the URDF
constexpr Interval kTwist = {5e-4, 0.3};  // rad, of a joint under its largest torque; gears 0.02
constexpr double kMostRotor = 1e4;        // rad/s^2, of a rotor under its largest torque
constexpr double kOtherTorque = 30.0;     // ratio of two ratings of one joint
constexpr double kFarther = 10.0;         // times what the frame reaches

std::string joint_key(const model::Joint& joint, const char* quantity) {
  return fmt::format("joints.{}.{}", joint.name, quantity);
}

// The largest effort of the arm against the largest torque that its weight needs. One effort of all
// joints stands for an unknown one.
void compare_efforts(const DeviceModel& model, const workspace::Survey& survey, Collector& out) {
  if (survey.postures.empty()) return;
  constexpr double kLeast = 1.0;  // Nm; arms without masses, or that swing about upright axes only
  double need = 0.0, most = 0.0, least = kInfinity;
  const model::Joint* strongest = nullptr;
  for (int i = model.n_p; i < model.n_p + model.n_m; ++i) {
    const model::Joint& joint = model.chain.joints()[i];
    if (joint.is_slide() || !std::isfinite(joint.effort_max)) continue;
    need = std::max(need, survey.gravity_max[i]);
    least = std::min(least, joint.effort_max);
    if (joint.effort_max <= most) continue;
    most = joint.effort_max;
    strongest = &joint;
  }
  if (need < kLeast || most <= kMostEffort * need || most == least) return;
  const std::string suspected =
      suspected_unit(most, {need, kUsualEffort * need}, kOtherTorques, "Nm");
  if (suspected.empty()) return;
  out.add_at_urdf(
      Severity::kWarning, "joint", strongest->name,
      fmt::format("<limit> effort: {:.4g} Nm are {:.3g} times what holds the arm up; {}", most,
                  most / need, suspected),
      "give effort in Nm");
}

void compare_motion(const limits::JointLimits& limits, const std::string& item, Collector& out) {
  if (!std::isfinite(limits.dq_max) || !std::isfinite(limits.ddq_max)) return;
  const double most = limits.dq_max / kQuickest;
  if (is_power_of_ten(limits.ddq_max)) return;
  const std::string suspected =
      suspected_unit(limits.ddq_max, {0.0, most}, kOtherAccelerations, "rad/s^2");
  if (suspected.empty()) return;
  out.add(
      Severity::kWarning, item,
      fmt::format("with {:.4g} rad/s^2 the full speed of {:.4g} rad/s takes {:.2g} ms; {}",
                  limits.ddq_max, limits.dq_max, 1e3 * limits.dq_max / limits.ddq_max, suspected),
      "give ddq_max_rad_per_s2 in rad/s^2");
}

void compare_speed(const model::Joint& joint, double dq_max, Collector& out) {
  if (!std::isfinite(joint.velocity_max) || is_odd_speed(dq_max)) return;
  const std::string suspected =
      suspected_unit(dq_max, {0.0, kFaster * joint.velocity_max}, kOtherSpeeds, "rad/s");
  if (suspected.empty()) return;
  out.add(Severity::kWarning, joint_key(joint, "dq_max_rad_per_s"),
          fmt::format("{:.4g} rad/s are {:.3g} times the velocity of the URDF; {}", dq_max,
                      dq_max / joint.velocity_max, suspected),
          "give dq_max_rad_per_s in rad/s");
}

void compare_actuator(const model::Joint& joint, const ActuatorModel& actuator, double ddq_max,
                      Collector& out) {
  const auto warn = [&](const char* key, const std::string& what, const std::string& suspected) {
    if (suspected.empty()) return;
    out.add(Severity::kWarning, fmt::format("actuators.{}.{}", joint.name, key),
            what + "; " + suspected, fmt::format("give {} in {}", key, config::unit_of(key)));
  };
  const double torque = std::min(actuator.torque_max, joint.effort_max);
  warn("stiffness_Nm_per_rad",
       fmt::format("{:.4g} Nm/rad twist by {:.2g} rad under the largest torque, {:.4g} Nm",
                   actuator.stiffness, torque / actuator.stiffness, torque),
       suspected_unit(actuator.stiffness, {torque / kTwist.ub, torque / kTwist.lb},
                      kOtherStiffnesses, "Nm/rad"));
  warn("rotor_inertia_kg_m2",
       fmt::format("{:.4g} Nm turn this rotor with {:.2g} rad/s^2, the joint with {:.4g}", torque,
                   torque / actuator.rotor_inertia, ddq_max),
       suspected_unit(actuator.rotor_inertia, {torque / kMostRotor, torque / ddq_max},
                      kOtherInertias, "kg m^2"));
  if (!std::isfinite(joint.effort_max)) return;
  const double effort = joint.effort_max;
  warn("torque_max_Nm",
       fmt::format("{:.4g} Nm beside the effort of the URDF, {:.4g} Nm", actuator.torque_max,
                   effort),
       suspected_unit(actuator.torque_max, {effort / kOtherTorque, effort * kOtherTorque},
                      kOtherTorques, "Nm"));
}

// Boxes in which a frame never comes near to a wall.
void compare_boxes(const DeviceModel& model, const workspace::Survey& survey, Collector& out) {
  for (std::size_t k = 0; k < survey.cloud.frames.size(); ++k) {
    const Eigen::AlignedBox3d& reached = survey.cloud.frames[k];
    if (reached.isEmpty()) continue;
    const double reach =
        std::max(1.0, reached.min().cwiseAbs().cwiseMax(reached.max().cwiseAbs()).maxCoeff());
    for (int axis = 0; axis < 3; ++axis) {
      const limits::JointLimits& range = model.cartesian_limits[k].axes[axis];
      for (const double end : {range.q_min, range.q_max}) {
        const std::string suspected =
            suspected_unit(end, {-kFarther * reach, kFarther * reach}, kOtherLengths, "m");
        if (suspected.empty() || !doubt_of_length(end).empty()) continue;
        out.add(Severity::kWarning,
                fmt::format("cartesian_limits[{}].{}.{}", k, "xyz"[axis],
                            end == range.q_min ? "q_min_m" : "q_max_m"),
                fmt::format("{:.4g} m are far beyond the {:.3g} m that the frame reaches; {}", end,
                            reach, suspected),
                "give the walls in metres");
      }
    }
  }
}

}  // namespace

void compare_units(const config::DeviceConfig& device, const workspace::Survey& survey,
                   Collector& out) {
  const DeviceModel& model = device.model;
  compare_efforts(model, survey, out);
  compare_boxes(model, survey, out);
  for (int i = 0; i < model.n_m; ++i) {
    const model::Joint& joint = model.chain.joints()[model.n_p + i];
    if (joint.is_slide()) continue;
    const limits::JointLimits& limits = model.joint_limits[i];
    compare_motion(limits, joint_key(joint, "ddq_max_rad_per_s2"), out);
    compare_speed(joint, limits.dq_max, out);
    if (model.actuators.empty()) continue;
    compare_actuator(joint, model.actuators[i], limits.ddq_max, out);
  }
  for (std::size_t k = 0; k < model.virtual_joints.size(); ++k) {
    compare_motion(model.virtual_joints[k].limits,
                   fmt::format("virtual_joints[{}].ddq_max_rad_per_s2", k), out);
  }
}

void compare_units(const config::Twin& twin, double mass, Collector& out) {
  const std::string grams = suspected_unit(mass, {0.0, kMostFelt}, kOtherMasses, "kg");
  const bool is_doubted = std::ranges::count(out.findings, "free_body.mass_kg", &Finding::item) > 0;
  if (!grams.empty() && !is_doubted) {
    out.add(
        Severity::kWarning, "end_effector",
        fmt::format("the hand moves {:.4g} kg at least, more than a person can; {}", mass, grams),
        "give <mass> in kg and <inertia> in kg m^2");
  }
  for (const rendering::TwinDof& dof : twin.model.dofs) {
    if (!dof.is_angle || dof.q_index < 0) continue;
    compare_motion(dof.limits, fmt::format("joints.{}.ddq_max_rad_per_s2", dof.name), out);
    const double travel =
        std::max(std::abs(dof.limits.q_min - dof.rest), std::abs(dof.limits.q_max - dof.rest));
    if (!std::isfinite(travel) || dof.stiffness <= 0.0 || dof.preload != 0.0) continue;
    const double largest = dof.stiffness * travel;
    const std::string suspected = suspected_unit(dof.stiffness, {dof.friction / travel, kInfinity},
                                                 kOtherStiffnesses, "Nm/rad");
    if (suspected.empty()) continue;
    out.add(Severity::kWarning, fmt::format("joints.{}.stiffness_Nm_per_rad", dof.name),
            fmt::format("the spring pulls with {:.3g} Nm at most, the friction of the joint is "
                        "{:.3g} Nm; {}",
                        largest, dof.friction, suspected),
            "give stiffness_Nm_per_rad in Nm/rad");
  }
}

std::string doubt_of_weight(double need, double rating) {
  constexpr double kFarTooWeak = 3.0, kFarTooHeavy = 30.0;
  if (need > kFarTooHeavy * rating && need <= 1e3 * rating) {
    return "; suspected grams: masses of the URDF or tool 1000 times smaller";
  }
  if (need < kFarTooWeak * rating) return "";
  constexpr std::array kOther = {kOtherTorques[0]};  // the others are smaller than Nm
  const std::string suspected = suspected_unit(rating, {need, kUsualEffort * need}, kOther, "Nm");
  return suspected.empty() ? "" : "; " + suspected;
}

}  // namespace hg::check
