#include "hg/check/twin_inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/check/ignored_urdf.h"
#include "hg/check/stiffness.h"
#include "hg/check/twin_bodies.h"
#include "hg/check/unit_comparison.h"
#include "hg/check/unit_inspection.h"
#include "hg/controller/rendering/twin_elements.h"
#include "hg/core/linear_algebra.h"
#include "hg/model/chain_data.h"
#include "hg/model/joint_range.h"
#include "hg/workspace/survey.h"

namespace hg::check {
namespace {

using rendering::Element;
using rendering::TorqueAt;
using rendering::Total;

constexpr double kRoundedUp = 1.0 + 1e-9;  // where a limit is derived from another one
constexpr int kPostures = 500;
constexpr std::uint64_t kSeed = 1;
constexpr double kLightMass = 1.5, kLightInertia = 0.015;  // kg, kg m^2: half of [C] 3

// "joints.hinge.dq_max_rad_per_s" for ("dq_max", "rad_per_s", "m_per_s")
std::string dof_key(const rendering::TwinDof& dof, const char* quantity, const char* angle,
                    const char* length) {
  return fmt::format("joints.{}.{}_{}", dof.name, quantity, dof.is_angle ? angle : length);
}

// Largest speed of a joint by the URDF, rad/s or m/s; infinite where none is given.
double velocity_max_of(const config::Twin& twin, const std::string& joint) {
  for (const model::Urdf& urdf : urdfs_among(twin.sources)) {
    const auto found = std::ranges::find(urdf.joints, joint, &model::UrdfJoint::name);
    if (found != urdf.joints.end()) return found->velocity_max;
  }
  return kInfinity;
}

void inspect_mass_matrix(const TwinFigures& figures, Collector& out) {
  constexpr double kPoor = 1e5, kHopeless = 1e9;
  if (figures.condition < kPoor) return;
  out.add(figures.condition < kHopeless ? Severity::kWarning : Severity::kFault, "urdf",
          fmt::format("the condition number of the mass matrix reaches {:.1e}, expected below "
                      "{:.0e}: light links behind heavy ones cannot be computed well",
                      figures.condition, kPoor),
          "give the lightest links and rotors more inertia, or fix their joints");
}

void inspect_weight(const TwinFigures& figures, Collector& out) {
  if (!can_be_pushed(figures.mass)) {
    out.add(Severity::kWarning, "end_effector",
            "no joint moves it along any direction: a hand there can only turn it",
            "name a link away from the axes, where the mechanism is held");
    return;
  }
  if (figures.mass < kLightMass) {
    out.add(
        Severity::kWarning, "end_effector",
        fmt::format("in some direction the hand moves only {} kg, expected 3 kg, at least {:g}: "
                    "a light twin may swing with a stiff hand",
                    rounded_down(figures.mass, 2), kLightMass),
        "give the moving links more mass, or their joints more damping");
  }
  if (figures.inertia < kLightInertia) {
    out.add(Severity::kWarning, "end_effector",
            fmt::format("about some axis the hand turns only {} kg m^2, expected 0.03, at least "
                        "{:g}: a light twin may swing with a stiff hand",
                        rounded_down(figures.inertia, 2), kLightInertia),
            "give the moving links more inertia, or their joints more damping");
  }
}

// Joints that follow others have no limits of their own in the law: those of the leader must hold
// theirs.
void inspect_followers(const config::Twin& twin, Collector& out) {
  for (const model::Coupling& coupling : twin.model.chain.couplings()) {
    const auto leader =
        std::ranges::find(twin.model.dofs, coupling.leader, &rendering::TwinDof::name);
    if (leader == twin.model.dofs.end()) continue;
    const limits::JointLimits& limits = leader->limits;
    const double ratio = coupling.curve ? coupling.curve->steepest() : std::abs(coupling.ratio);
    const double largest = velocity_max_of(twin, coupling.joint) / ratio;
    if (limits.dq_max > largest * kRoundedUp) {
      out.add(Severity::kWarning, dof_key(*leader, "dq_max", "rad_per_s", "m_per_s"),
              fmt::format("with {:.4g} {} the joint {}, which follows, moves {:.3g} times as fast: "
                          "{:.3g}, more than its {:.3g}",
                          limits.dq_max, leader->is_angle ? "rad/s" : "m/s", coupling.joint, ratio,
                          ratio * limits.dq_max, ratio * largest),
              "lower it to " + rounded_down(largest, 4));
    }
    if (!coupling.curve) continue;
    const Interval range = coupling.curve->range();
    if (limits.q_min >= range.lb && limits.q_max <= range.ub) continue;
    out.add(Severity::kWarning, dof_key(*leader, "q_max", "rad", "m"),
            fmt::format("moves in {:.4g} .. {:.4g}, but the curve that {} follows is given for "
                        "{:.4g} .. {:.4g}: beyond it is straight",
                        limits.q_min, limits.q_max, coupling.joint, range.lb, range.ub),
            "stay within the curve, or give it for the whole range");
  }
}

void inspect_limits(const rendering::TwinDof& dof, double start, Collector& out) {
  const limits::JointLimits& limits = dof.limits;
  const char* unit = dof.is_angle ? "rad" : "m";
  const double range = limits.q_max - limits.q_min;
  if (start < limits.q_min || start > limits.q_max) {
    out.add(Severity::kFault, dof_key(dof, "start", "rad", "m"),
            fmt::format("starts at {:.3g} {}, outside {:.3g} .. {:.3g}", start, unit, limits.q_min,
                        limits.q_max),
            "start within the limits");
  }
  const bool has_stop = std::isfinite(limits.q_min) || std::isfinite(limits.q_max);
  if (has_stop && range > 0.0 && !std::isfinite(limits.ddq_max)) {
    out.add(Severity::kWarning, dof_key(dof, "ddq_max", "rad_per_s2", "m_per_s2"),
            "is not given: at its stops the joint brakes harder than any device can follow",
            "give what the device can brake; check names the largest value when it is given the "
            "device as well");
    return;
  }
  const double braking = limits.dq_max * limits.dq_max / (2.0 * limits.ddq_max);
  if (range <= 0.0 || !std::isfinite(braking) || braking <= range) return;
  out.add(Severity::kWarning, dof_key(dof, "dq_max", "rad_per_s", "m_per_s"),
          fmt::format("braking from {:.3g} {}/s takes {:.3g} {}, more than the whole range {:.3g}: "
                      "the joint never gets faster than {:.2g}",
                      limits.dq_max, unit, braking, unit, range, std::sqrt(limits.ddq_max * range)),
          fmt::format("lower it to {}, or raise ddq_max as far as the device can brake",
                      rounded_down(std::sqrt(limits.ddq_max * range), 2)));
}

// The law holds a spring's torque over a period. With c = d dt / m and k = K dt^2 / m that is
// stable for k / 2 < c < 2; it shows no more damping than c = 1, however large it is set.
void inspect_springs(const rendering::TwinDof& dof, double inertia, double dt, Collector& out) {
  const Total stiffness = total_of(&Element::stiffness, dof, TorqueAt::kBegin);
  const Total damping = total_of(&Element::damping, dof);
  const Total friction = total_of(&Element::friction, dof);
  const double c = damping.value * dt / inertia;
  const double k = stiffness.value * dt * dt / inertia;
  if (c >= 1.0) {
    out.add(Severity::kWarning, item_of(*damping.most, dof),
            fmt::format("damping * dt / inertia is {:.3g} with the {:.2g} {} that move in the "
                        "lightest posture, expected below 1: the rate cannot show so much",
                        c, inertia, dof.is_angle ? "kg m^2" : "kg"),
            fmt::format("lower it to {}, or give the links more inertia",
                        rounded_down(inertia / dt, 2)));
  }
  if (k >= 1.0) {
    out.add(k < 4.0 ? Severity::kWarning : Severity::kFault, item_of(*stiffness.most, dof),
            fmt::format("stiffness * dt^2 / inertia is {:.3g}, must be below 1: the spring is too "
                        "stiff for the rate",
                        k),
            fmt::format("lower it to {}, or give the links more inertia",
                        rounded_down(0.5 * inertia / (dt * dt), 2)));
  } else if (0.5 * k > c && friction.value == 0.0) {
    out.add(Severity::kWarning, item_of(*damping.most, dof),
            fmt::format("{:g} is less than stiffness * dt / 2 = {:.2g}: the spring gains energy "
                        "while the twin is not held",
                        damping.value, 0.5 * stiffness.value * dt),
            fmt::format("raise it to {} or more", rounded_up(stiffness.value * dt, 2)));
  }
}

// A torque over position that is taken in the middle of a period gains no energy and is stable for
// a slope of K dt^2 / m < 4.
void inspect_slopes(const rendering::TwinDof& dof, double inertia, double dt, Collector& out) {
  const Total stiffness = total_of(&Element::stiffness, dof, TorqueAt::kMiddle);
  const double k = stiffness.value * dt * dt / inertia;
  if (k < 1.0) return;
  const char* unit = dof.is_angle ? "Nm/rad" : "N/m";
  out.add(
      k < 4.0 ? Severity::kWarning : Severity::kFault, item_of(*stiffness.most, dof),
      fmt::format("its steepest part has {:.3g} {}, expected less than inertia / dt^2 = {:.3g}: "
                  "it is too steep for the rate",
                  stiffness.value, unit, inertia / (dt * dt)),
      "move its points apart, or give the links more inertia");
}

}  // namespace

std::vector<ConfigurationA> twin_postures(const config::Twin& twin, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<ConfigurationA> postures = {twin.model.q_start};
  while (static_cast<int>(postures.size()) < count) {
    ConfigurationA q = twin.model.q_start;
    for (const rendering::TwinDof& dof : twin.model.dofs) {
      if (dof.q_index < 0) continue;
      const Interval range =
          model::finite_range({dof.limits.q_min, dof.limits.q_max}, dof.is_angle);
      q[dof.q_index] = range.lb + random.next() * (range.ub - range.lb);
    }
    postures.push_back(q);
  }
  return postures;
}

TwinFigures twin_figures(const config::Twin& twin, const std::vector<ConfigurationA>& postures) {
  model::ChainData chain(twin.model.chain);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(chain.model().nv());
  TwinFigures figures;
  figures.smallest_inertia = VectorA::Constant(chain.model().nv(), kInfinity);
  for (const ConfigurationA& q : postures) {
    chain.update(q, zero);
    const Eigen::VectorXd eigenvalues = symmetric_eigen(chain.M()).values;
    const double smallest = eigenvalues[0], largest = eigenvalues[eigenvalues.size() - 1];
    figures.condition =
        std::max(figures.condition, smallest > 0.0 ? largest / smallest : kInfinity);

    const Eigen::MatrixXd inverse = hg::inverse(chain.M());
    figures.smallest_inertia =
        figures.smallest_inertia.cwiseMin(VectorA(inverse.diagonal().cwiseInverse()));
    const model::Jacobian J = chain.jacobian(twin.model.end_effector);
    const Eigen::Matrix<double, 6, 6> mobility = J * inverse * J.transpose();
    const auto lightest = [](const Eigen::Matrix3d& part) {
      return 1.0 / symmetric_eigen(part).values[2];
    };
    figures.mass = std::min(figures.mass, lightest(mobility.topLeftCorner<3, 3>()));
    figures.inertia = std::min(figures.inertia, lightest(mobility.bottomRightCorner<3, 3>()));
  }
  return figures;
}

Findings inspect(const config::Twin& twin, double dt) {
  Collector out(twin.sources, twin.places);
  const TwinFigures figures = twin_figures(twin, twin_postures(twin, kPostures, kSeed));
  inspect_mass_matrix(figures, out);
  inspect_weight(figures, out);
  inspect_bodies(twin.sources, joint_names(twin.model.chain), out);
  inspect_units(twin.sources, joint_names(twin.model.chain), out);
  compare_units(twin, figures.mass, out);
  inspect_followers(twin, out);
  inspect_ignored(twin.sources, UrdfUse::kTwin, out);
  for (std::size_t i = 0; i < twin.model.dofs.size(); ++i) {
    const rendering::TwinDof& dof = twin.model.dofs[i];
    if (dof.q_index >= 0) inspect_limits(dof, twin.model.q_start[dof.q_index], out);
    inspect_springs(dof, figures.smallest_inertia[i], dt, out);
    inspect_slopes(dof, figures.smallest_inertia[i], dt, out);
  }
  return std::move(out.findings);
}

}  // namespace hg::check
