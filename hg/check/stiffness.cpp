#include "hg/check/stiffness.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hg/check/drive_loop.h"
#include "hg/controller/rendering/braking.h"
#include "hg/controller/rendering/twin_elements.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/start_posture.h"

namespace hg::check {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kPhase_deg = 16.5;  // see frequency_Hz()
constexpr double kLeastWay = 0.01;   // m at the handle, over which a spring should be followed

bool has_position_drives(const config::SimulatedDeviceConfig& device) {
  return plant_of(device) == config::PlantKind::kPositionDrives;
}

// Mean delay between a wrench and the reaction of the motors.
double delay_of(const config::SimulatedDeviceConfig& device) {
  if (has_position_drives(device)) return drive_delay(device);
  double delay = device.control.loop.latency;
  if (device.estimation.wrench.low_pass_Hz > 0.0) {
    delay += 1.0 / (kTurn * device.estimation.wrench.low_pass_Hz);
  }
  // the simulation file is the only source on the sensor
  const simulator::SensorFilterConfig& filter = device.simulation.sensors.wrench.filter;
  if (device.simulation.is_from_file) delay += 0.5 * filter.average + filter.delay;
  return delay;
}

std::optional<scenario::Start> start_of(const config::DeviceConfig& device,
                                        const config::Twin& twin) {
  try {
    return scenario::find_start(device, twin);
  } catch (const SetupError&) {  // where the device does not get there it is stated itself
    return {};
  }
}

// The least along the axes of B.
double braking_of(const DeviceModel& device, const scenario::Start& start) {
  const rendering::DeviceMotion motion = {.q_p = start.q_p,
                                          .dq_p = VectorP::Zero(device.n_p),
                                          .q_m = start.q_m,
                                          .dq_m = VectorM::Zero(device.n_m)};
  double least = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      least = std::min(least, rendering::largest_acceleration(device, motion,
                                                              side * Eigen::Vector3d::Unit(axis)));
    }
  }
  return least;
}

double damping_of(const surfaces::Surface& surface, const Interval& mass, double period) {
  return surface.damping.value_or(surfaces::critical_damping(surface.stiffness, mass, period));
}

// Directions in B in which a surface pushes: across its faces, for curved ones along the axes.
Eigen::Matrix3Xd normals(const surfaces::Surface& surface) {
  const Eigen::Matrix3d R = surface.pose.R;
  if (std::holds_alternative<surfaces::Plane>(surface.shape)) return R.col(2);
  if (std::holds_alternative<surfaces::Box>(surface.shape)) return R;
  return Eigen::Matrix3d::Identity();
}

// What the twin can be in the loop of hand and drives.
CalmTwin close_loop(const config::SimulatedDeviceConfig& device, const scenario::Start& start,
                    const StiffnessLimits& limits, const Interval& mass,
                    std::span<const surfaces::Surface> surfaces) {
  CalmTwin calm;
  const VectorPM q = stacked(start.q_p, start.q_m);
  const DriveLoop loop(device, q);
  for (int axis = 0; axis < 3; ++axis) {
    calm.stiffness[axis] = loop.stiffest_wall(axis, limits.mass, limits.damping);
    calm.mass[axis] = loop.lightest_mass(axis, limits.damping);
  }
  const double scale = can_be_pushed(limits.mass) ? mass.lb / limits.mass : 1.0;
  for (const surfaces::Surface& surface : surfaces) {
    double& stiffest = calm.surfaces.emplace_back(kInfinity);
    if (surface.contact == surfaces::Contact::kStop) continue;
    if (limits.mass < std::ranges::max(calm.mass)) stiffest = 0.0;
    const Eigen::Matrix3Xd directions = normals(surface);
    const DriveLoop across(device, q, directions);
    const double damping = limits.damping + damping_of(surface, mass, limits.period) / scale;
    for (int i = 0; i < directions.cols(); ++i) {
      stiffest = std::min(stiffest, across.stiffest_wall(i, limits.mass, damping));
    }
  }
  return calm;
}

std::string kilo(double stiffness) { return fmt::format("{:.2g} kN/m", 1e-3 * stiffness); }

std::string by_axis(const std::array<double, 3>& values, double scale) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    const double value = scale * values[axis];
    text += fmt::format("{}{} ", axis > 0 ? ", " : "", "xyz"[axis]);
    if (!std::isfinite(value)) {
      text += "any";
    } else {
      text += value < 100.0 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
    }
  }
  return text;
}

double frequency_of(double stiffness, double mass) { return std::sqrt(stiffness / mass) / kTurn; }

std::string frequency_text(const StiffnessLimits& limits) {
  if (!limits.calm) {
    return fmt::format("up to {:.1f} Hz, where T_d is {:g} degrees, which is {} = m (2 pi f)^2",
                       limits.frequency_Hz(), kPhase_deg, kilo(limits.by_frequency()));
  }
  if (limits.by_frequency() == 0.0) {
    return fmt::format(
        "none along some axis, as in a hand it shakes without one below {} kg; across {} kN/m",
        by_axis(limits.calm->mass, 1.0), by_axis(limits.calm->stiffness, 1e-3));
  }
  double stiffest = limits.by_frequency();
  std::string where;
  const std::vector<double>& each = limits.calm->surfaces;
  if (!each.empty() && std::isfinite(std::ranges::min(each))) {
    stiffest = std::min(std::ranges::min(each), surfaces::kStiffness.ub);
    where = " on the surfaces of the scenario";
  }
  return fmt::format(
      "up to {:.1f} Hz, where drives and elastic joints take the damping of a hand, which is {}{} "
      "(across {} kN/m; without a surface it shakes below {} kg)",
      std::min(frequency_of(stiffest, limits.mass), 0.25 / limits.delay), kilo(stiffest), where,
      by_axis(limits.calm->stiffness, 1e-3), by_axis(limits.calm->mass, 1.0));
}

std::string swing_text(const StiffnessLimits& limits, std::size_t surface) {
  const double stiffest = limits.by_frequency(surface);
  if (stiffest > 0.0) {
    return fmt::format("the body swings on it up to {:.1f} Hz",
                       frequency_of(stiffest, limits.mass));
  }
  return fmt::format("in a hand the body shakes without it below {} kg",
                     by_axis(limits.calm->mass, 1.0));
}

std::string known_of(const StiffnessLimits& limits) {
  return fmt::format(
      "{:.2g} kg and {:.2g} Ns/m as felt at the handle; T = {:g} ms, T_d = {:.1f} ms from "
      "wrench to motion",
      limits.mass, limits.damping, 1e3 * limits.period, 1e3 * limits.delay);
}

std::string acceleration_text(const StiffnessLimits& limits) {
  if (!std::isfinite(limits.acceleration)) {
    return "neither motors nor Cartesian limits state what the handle brakes with";
  }
  return fmt::format(
      "{} = m (a / v)^2 where it is met with v = {:g} m/s and the handle brakes with "
      "a = {:.3g} m/s^2",
      kilo(limits.by_acceleration(kFeelingSpeed)), kFeelingSpeed, limits.acceleration);
}

struct Spring {
  const rendering::TwinDof* dof = nullptr;
  double inertia = 0.0;        // moving inertia, kg m^2 or kg
  rendering::Total stiffness;  // Nm/rad or N/m, of all elements, each where it is steepest
};

// Those of which `worth` is below `least`, one finding about the worst.
template <typename Worth, typename Text>
void warn_of(const std::vector<Spring>& springs, double least, const Worth& worth, const Text& text,
             Collector& out) {
  const auto worst = std::ranges::min_element(springs, {}, worth);
  if (worst == springs.end() || worth(*worst) >= least) return;
  const auto others =
      std::ranges::count_if(springs, [&](const Spring& spring) { return worth(spring) < least; }) -
      1;
  const rendering::TwinDof& dof = *worst->dof;
  const double share = worth(*worst) / least;
  out.add(
      Severity::kWarning, rendering::item_of(*worst->stiffness.most, dof),
      fmt::format("{:g} {} on {:.2g} {} {}{}", worst->stiffness.value,
                  dof.is_angle ? "Nm/rad" : "N/m", worst->inertia, dof.is_angle ? "kg m^2" : "kg",
                  text(*worst), others > 0 ? fmt::format("; so do {} other joints", others) : ""),
      fmt::format("lower it to {}, or give the joint more inertia",
                  rounded_down(share * worst->stiffness.value, 2)));
}

void inspect_springs(const config::Twin& twin, const StiffnessLimits& limits, Collector& out) {
  model::ChainData chain(twin.model.chain);
  chain.update(twin.model.q_start, VectorA::Zero(chain.model().nv()));
  const Eigen::MatrixXd mobility = inverse(Eigen::MatrixXd(chain.M() * twin.model.mass_scale));
  std::vector<Spring> springs;
  for (std::size_t i = 0; i < twin.model.dofs.size(); ++i) {
    const rendering::TwinDof& dof = twin.model.dofs[i];
    const auto k = static_cast<Eigen::Index>(i);
    const rendering::Total stiffness = rendering::total_of(&rendering::Element::stiffness, dof);
    if (stiffness.value > 0.0) springs.push_back({&dof, 1.0 / mobility(k, k), stiffness});
  }
  const double fastest = limits.frequency_Hz();
  warn_of(
      springs, 1.0,
      [&](const Spring& spring) {
        return spring.inertia * std::pow(kTurn * fastest, 2) / spring.stiffness.value;
      },
      [&](const Spring& spring) {
        return fmt::format(
            "swing with {:.1f} Hz; this device shows up to {:.1f} Hz, where the "
            "{:.1f} ms from wrench to motion are {:.3g} degrees",
            std::sqrt(spring.stiffness.value / spring.inertia) / kTurn, fastest, 1e3 * limits.delay,
            360.0 * fastest * limits.delay);
      },
      out);
  // how far from its rest the handle may be: its lever cancels
  const auto way = [&](const Spring& spring) {
    return spring.inertia * limits.acceleration / spring.stiffness.value;
  };
  warn_of(
      springs, kLeastWay, way,
      [&](const Spring& spring) {
        return fmt::format(
            "follow their spring up to {:.1f} mm of the handle, I a / K with a = "
            "{:.3g} m/s^2, expected {:g} mm: from there on "
            "they swing slower, and their swings may grow",
            1e3 * way(spring), limits.acceleration, 1e3 * kLeastWay);
      },
      out);
}

}  // namespace

double StiffnessLimits::frequency_Hz() const noexcept {
  const double by_phase = kPhase_deg / 360.0 / delay;
  return calm ? std::min(frequency_of(by_frequency(), mass), 0.25 / delay) : by_phase;
}

double StiffnessLimits::by_frequency() const noexcept {
  if (calm) return std::ranges::min(calm->stiffness);
  return mass * std::pow(kTurn * frequency_Hz(), 2);
}

double StiffnessLimits::by_frequency(std::size_t surface) const noexcept {
  return calm ? calm->surfaces[surface] : by_frequency();
}

double StiffnessLimits::by_passivity(double extra) const noexcept {
  return (damping + extra) / (0.5 * period + delay);
}

double StiffnessLimits::by_acceleration(double speed) const noexcept {
  return mass * std::pow(acceleration / speed, 2);
}

double StiffnessLimits::meeting_speed(double stiffness) const noexcept {
  return acceleration * std::sqrt(mass / stiffness);
}

FeltTwin felt_twin(const config::Twin& twin) {
  const auto [mass, dq] = rendering::felt_mass(twin.model, twin.model.felt_scale.head<3>());
  return {.mass = mass, .damping = felt_damping(twin.model, dq)};
}

double felt_damping(const rendering::TwinModel& twin, const Eigen::VectorXd& dq) {
  double damping = 0.0;
  for (std::size_t i = 0; i < twin.dofs.size(); ++i) {
    const double speed = dq[static_cast<Eigen::Index>(i)];
    damping +=
        rendering::total_of(&rendering::Element::damping, twin.dofs[i]).value * speed * speed;
  }
  return damping;
}

StiffnessLimits stiffness_limits(const config::SimulatedDeviceConfig& device,
                                 const config::Twin& twin,
                                 std::span<const surfaces::Surface> surfaces) {
  const FeltTwin felt = felt_twin(twin);
  StiffnessLimits limits = {.mass = felt.mass.lb,
                            .damping = felt.damping,
                            .period = device.model.dt(),
                            .delay = std::max(delay_of(device), device.model.dt())};
  const std::optional<scenario::Start> start = start_of(device, twin);
  if (start) limits.acceleration = braking_of(device.model, *start);
  if (start && has_position_drives(device)) {
    limits.calm =
        close_loop(device, *start, limits, rendering::felt_mass(twin.model).mass, surfaces);
  }
  return limits;
}

void inspect_stiffness(const config::SimulatedDeviceConfig& device, const config::Twin& twin,
                       std::span<const surfaces::Surface> surfaces, Collector& out) {
  const StiffnessLimits limits = stiffness_limits(device, twin, surfaces);
  if (!can_be_pushed(limits.mass)) return;
  out.add(Severity::kNote, "end_effector",
          fmt::format(
              "surfaces and springs that this device can show with this twin ({}): {}; {}; passive "
              "in any hand up to {} = b / (T / 2 + T_d), with 20 Ns/m of a surface {}",
              known_of(limits), frequency_text(limits), acceleration_text(limits),
              kilo(limits.by_passivity(0.0)), kilo(limits.by_passivity(20.0))),
          "");
  inspect_springs(twin, limits, out);
}

Findings inspect_surfaces(const config::Scenario& scenario) {
  Collector out(scenario.sources, scenario.places);
  if (scenario.surfaces.empty()) return {};
  const StiffnessLimits limits =
      stiffness_limits(scenario.device, scenario.twin, scenario.surfaces);
  if (!can_be_pushed(limits.mass)) return {};
  const Interval mass = rendering::felt_mass(scenario.twin.model).mass;
  const double scale = mass.lb / limits.mass;  // what is felt is divided by it
  for (std::size_t i = 0; i < scenario.surfaces.size(); ++i) {
    const surfaces::Surface& surface = scenario.surfaces[i];
    if (surface.contact == surfaces::Contact::kStop) continue;
    const double damping = damping_of(surface, mass, limits.period);
    if (surface.damping && damping > mass.lb / limits.period) {
      out.add(
          Severity::kWarning, fmt::format("surfaces[{}].damping_Ns_per_m", i),
          fmt::format("{:g} Ns/m of '{}' is more than samples of {:g} ms allow for {:.2g} kg, "
                      "m / T = {:.3g} Ns/m",
                      damping, surface.name, 1e3 * limits.period, mass.lb, mass.lb / limits.period),
          "lower it, or leave it out: then it is critical for the twin");
    }
    const std::array<std::pair<double, std::string>, 3> bounds = {
        {{limits.by_frequency(i), swing_text(limits, i)},
         {limits.by_acceleration(kFeelingSpeed),
          fmt::format("a hand at {:g} m/s needs no more than the handle's {:.3g} m/s^2",
                      kFeelingSpeed, limits.acceleration)},
         {limits.by_passivity(damping / scale),
          fmt::format("it is passive in any hand with {:.3g} Ns/m, {}", damping,
                      surface.damping ? "as given" : "which is critical, as none is given")}}};
    std::string beyond;
    double most = surface.stiffness;
    for (const auto& [felt, why] : bounds) {
      const double bound = scale * felt;
      if (surface.stiffness <= bound) continue;
      beyond += fmt::format("{}{} ({})", beyond.empty() ? "" : ", ", kilo(bound), why);
      most = std::min(most, bound);
    }
    if (beyond.empty()) continue;
    const bool is_possible = most >= surfaces::kStiffness.lb;
    out.add(
        Severity::kWarning, fmt::format("surfaces[{}].stiffness_N_per_m", i),
        fmt::format("{:g} N/m of '{}' is more than this device shows: {}; {}. A hand faster than "
                    "{:.2f} m/s goes deeper than the spring alone would let it",
                    surface.stiffness, surface.name, beyond, known_of(limits),
                    limits.meeting_speed(surface.stiffness / scale)),
        is_possible
            ? fmt::format("lower it to {:.0f}, or raise its damping and the mass of the twin",
                          std::floor(most))
            : fmt::format("raise its damping and the mass of the twin: a surface has at least "
                          "{:g} N/m",
                          surfaces::kStiffness.lb));
  }
  return std::move(out.findings);
}

}  // namespace hg::check
