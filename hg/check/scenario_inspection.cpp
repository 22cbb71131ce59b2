#include "hg/check/scenario_inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "hg/check/stiffness.h"
#include "hg/check/twin_inspection.h"
#include "hg/check/way_force.h"
#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/start_posture.h"
#include "hg/workspace/survey.h"
#include "hg/workspace/way.h"

namespace hg::check {
namespace {

constexpr int kPostures = 150;  // of the twin; a generic device needs milliseconds for each
constexpr std::uint64_t kSeed = 1;
constexpr double kHigh = 0.95;

// One posture of the twin and the device in it.
struct Meeting {
  model::Jacobian J_a;
  std::optional<Eigen::MatrixXd> manipulator_of_twin;  // J_m^+ J_a, where the device gets there
};

// Values of one demand over the postures.
struct Collected {
  double acceleration = 0.0, speed = 0.0;
  std::vector<double> joint_acceleration;
  std::vector<int> device_joint;
};

// `hand` limits the handle along x, y, z of B
void collect(const DeviceModel& model, const std::array<limits::JointLimits, 3>& hand,
             const limits::JointLimits& limits, int dof, const Meeting& meeting, Collected& out) {
  const auto column = meeting.J_a.col(dof);
  for (std::size_t axis = 0; axis < hand.size(); ++axis) {
    const double lever = std::abs(column[axis]);
    if (std::isfinite(limits.ddq_max)) {
      out.acceleration = std::max(out.acceleration, lever * limits.ddq_max / hand[axis].ddq_max);
    }
    if (std::isfinite(limits.dq_max)) {
      out.speed = std::max(out.speed, lever * limits.dq_max / hand[axis].dq_max);
    }
  }
  if (!meeting.manipulator_of_twin || !std::isfinite(limits.ddq_max)) return;
  double largest = 0.0;
  int joint = 0;
  for (int i = 0; i < model.n_m; ++i) {
    const double share = std::abs((*meeting.manipulator_of_twin)(i, dof)) * limits.ddq_max /
                         model.joint_limits[i].ddq_max;
    if (share > largest) {
      largest = share;
      joint = i;
    }
  }
  out.joint_acceleration.push_back(largest);
  out.device_joint.push_back(joint);
}

Demand summary(const DeviceModel& model, const std::string& name, Collected& values) {
  Demand demand = {.joint = name,
                   .acceleration = values.acceleration,
                   .speed = values.speed,
                   .device_joint = {}};
  if (values.joint_acceleration.empty()) return demand;
  std::vector<std::size_t> order(values.joint_acceleration.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto at = static_cast<std::ptrdiff_t>(kHigh * static_cast<double>(order.size() - 1));
  std::ranges::nth_element(order, order.begin() + at, {},
                           [&](std::size_t i) { return values.joint_acceleration[i]; });
  const std::size_t high = order[at];
  demand.joint_acceleration = values.joint_acceleration[high];
  demand.device_joint = model.manipulator_joint(values.device_joint[high]);
  return demand;
}

std::string coordinates(const rendering::TwinModel& twin, const ConfigurationA& q) {
  std::string text;
  for (const rendering::TwinDof& dof : twin.dofs) {
    if (dof.q_index < 0) continue;
    text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", dof.name, q[dof.q_index]);
  }
  return text;
}

std::string key(const rendering::TwinDof& dof, const char* quantity, const char* power) {
  return fmt::format("joints.{}.{}_{}_per_s{}", dof.name, quantity, dof.is_angle ? "rad" : "m",
                     power);
}

void inspect_demand(const rendering::TwinDof& dof, const Demand& demand, Collector& out) {
  constexpr double kRounding = 1e-6;
  const auto add = [&](double share, const char* quantity, const char* power, double value,
                       const std::string& of) {
    if (share <= 1.0 + kRounding) return;
    out.add(Severity::kWarning, key(dof, quantity, power),
            fmt::format("{:g} takes {:.2f} times {}: the joint may run through its own limits",
                        value, share, of),
            "lower it to " + rounded_down(value / share, 2));
  };
  add(demand.acceleration, "ddq_max", "2", dof.limits.ddq_max,
      "the acceleration that the device's Cartesian limits give the handle");
  add(demand.speed, "dq_max", "", dof.limits.dq_max,
      "the speed that the device's Cartesian limits give the handle");
  add(demand.joint_acceleration, "ddq_max", "2", dof.limits.ddq_max,
      "the acceleration of the device's joint " + demand.device_joint +
          " in 5 % of the postures or more");
}

// The work of a cycle grows with the cube of the twin's degrees of freedom at most. Measured, 99.9
// % of the cycles (docs/reports/benchmarks.md): gauss 38 us with 20 and 79 us with 30, paper 1.2 ms
// with 30.
void inspect_work(const config::DeviceConfig& device, const config::Twin& twin, Collector& out) {
  const bool is_paper = device.rendering.law == rendering::Law::kPaper;
  const double most =
      std::floor((is_paper ? 20.0 : 40.0) * std::cbrt(1000.0 / device.model.rate_Hz) + 1e-9);
  const int dofs = twin.model.chain.nv();
  if (dofs <= most) return;
  out.add(
      Severity::kWarning, "urdf",
      fmt::format("the twin has {} degrees of freedom, expected at most {:g} with the law {} at "
                  "{:g} Hz: the cycle may take longer than its period",
                  dofs, most, is_paper ? "paper" : "gauss", device.model.rate_Hz),
      fmt::format("fix joints that need not move{}, or lower the device's rate_Hz",
                  is_paper ? ", take the law gauss" : ""));
}

bool has_start(const config::DeviceConfig& device, const config::Twin& twin, Collector& out) {
  try {
    scenario::find_start(device, twin);
    return true;
  } catch (const SetupError& error) {
    out.add(Severity::kFault, "placement", error.what(), "");
    return false;
  }
}

// What a hand meets that is led through all that the twin can do.
void inspect_way(const config::SimulatedDeviceConfig& device, const config::Twin& twin,
                 Collector& out) {
  try {
    const workspace::Way way = workspace::lead(device, twin);
    const std::string problem = workspace::problem_of(way);
    if (!problem.empty()) out.add(Severity::kWarning, "placement", problem, workspace::kCuresOfWay);
    inspect_way_forces(device, twin, way, out);
  } catch (const SetupError& error) {
    out.add(Severity::kFault, "placement", error.what(), "");
  }
}

}  // namespace

Match match(const config::DeviceConfig& device, const config::Twin& twin) {
  config::Twin moved = twin;
  const std::vector<ConfigurationA> postures = twin_postures(twin, kPostures, kSeed);
  const std::array<limits::JointLimits, 3> hand = handle_limits(device.model);
  model::ChainData twin_chain(twin.model.chain), device_chain(device.model.chain);
  const Eigen::VectorXd zero_a = Eigen::VectorXd::Zero(twin.model.chain.nv());
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(device.model.chain.nv());
  std::vector<Collected> values(twin.model.dofs.size());

  Match result;
  for (const ConfigurationA& q : postures) {
    ++result.postures;
    twin_chain.update_kinematics(q, zero_a);
    Meeting meeting = {twin_chain.jacobian(twin.model.end_effector), {}};
    moved.model.q_start = q;
    try {
      const scenario::Start start = scenario::find_start(device, moved);
      ++result.reached;
      device_chain.update_kinematics(stacked(start.q_p, start.q_m), zero);
      const model::Jacobian J_m =
          workspace::manipulator_jacobian(device.model, device_chain, device.model.handle);
      meeting.manipulator_of_twin =
          LeastSquares(J_m).pseudo_inverse() * Eigen::MatrixXd(meeting.J_a);
    } catch (const SetupError& error) {
      if (result.worst.empty()) {
        result.worst = error.what();
        result.q_worst = q;
      }
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      collect(device.model, hand, twin.model.dofs[i].limits, static_cast<int>(i), meeting,
              values[i]);
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.demands.push_back(summary(device.model, twin.model.dofs[i].name, values[i]));
  }
  return result;
}

Findings inspect(const config::SimulatedDeviceConfig& device, const config::Twin& twin,
                 std::span<const surfaces::Surface> surfaces) {
  Collector out(twin.sources, twin.places);
  const bool can_start = has_start(device, twin, out);
  inspect_work(device, twin, out);
  inspect_stiffness(device, twin, surfaces, out);
  const bool is_bounded = std::ranges::all_of(
      twin.model.dofs, [](const rendering::TwinDof& dof) { return dof.q_index >= 0; });
  if (!is_bounded) return std::move(out.findings);  // a floating twin goes where the device goes

  constexpr double kEnough = 0.5;  // below, most of what the twin can do is not to be felt
  const Match found = match(device, twin);
  const double share = static_cast<double>(found.reached) / found.postures;
  if (found.reached < found.postures) {
    out.add(share < kEnough ? Severity::kWarning : Severity::kNote, "placement",
            fmt::format("the device reaches {:.0f} % of the twin's postures; not {}: {}",
                        100.0 * share, coordinates(twin.model, found.q_worst), found.worst),
            "move or turn the placement, or narrow the limits of the twin's joints");
  }
  for (std::size_t i = 0; i < found.demands.size(); ++i) {
    inspect_demand(twin.model.dofs[i], found.demands[i], out);
  }
  if (can_start) inspect_way(device, twin, out);
  return std::move(out.findings);
}

Findings inspect_spheres(const config::Scenario& scenario) {
  const auto is_stop = [](const surfaces::Surface& surface) {
    return surface.contact == surfaces::Contact::kStop;
  };
  const rendering::TwinModel& twin = scenario.twin.model;
  if (twin.spheres.empty()) return {};
  Collector out(scenario.sources, scenario.places);
  if (std::ranges::none_of(scenario.surfaces, is_stop)) {
    out.add(Severity::kNote, "twin",
            "its collision_spheres meet nothing, since no surface of the scenario is a stop",
            "give a surface 'contact: stop'");
    return std::move(out.findings);
  }
  model::ChainData chain(twin.chain);
  chain.update_kinematics(twin.q_start, VectorA::Zero(twin.chain.nv()));
  for (std::size_t i = 0; i < twin.spheres.size(); ++i) {
    const int frame = twin.spheres[i].frame;
    if (!chain.jacobian(frame).isZero(0.0)) continue;
    out.add(Severity::kWarning, "twin",
            fmt::format("its collision_spheres[{}] is on '{}', which no joint moves", i,
                        twin.chain.frame_names()[frame]),
            "choose a link that moves");
  }
  return std::move(out.findings);
}

}  // namespace hg::check
