#include "hg/experiments/haptify/swing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "hg/controller/rendering/catalogue.h"
#include "hg/experiments/haptify/play.h"
#include "hg/experiments/player.h"
#include "hg/scenario/start_posture.h"

namespace hg::haptify {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMass = 5.0;   // kg, of which nothing is felt: it turns about its own centre
constexpr double kRange = 1.0;  // rad to either side: never met

// A body that turns about the vertical through p_B_hinge, with the handle at T_B_H when q = 0.
model::ChainModel hinge(double inertia, const Pose& T_B_hinge, const Pose& T_B_H) {
  const std::string text = fmt::format(
      R"(<robot name="hinge"><link name="base"/>
<joint name="hinge" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="{0}" upper="{1}" velocity="100" effort="1000"/></joint>
<link name="arm"><inertial><mass value="{2}"/>
<inertia ixx="{3}" iyy="{3}" izz="{3}" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>)",
      -kRange, kRange, kMass, inertia);
  const model::Tool handle = {.link = "arm", .T_link_handle = inverse(T_B_hinge) * T_B_H};
  return model::ChainModel::from_urdf_text(text, "hinge", {.T_B_root = T_B_hinge, .tool = handle});
}

config::Scenario prepared(const config::Scenario& scenario, const SwingConfig& config,
                          double stiffness, double deflection, std::uint64_t seed) {
  Pose T_B_H = scenario::handle_start(scenario.twin.model);
  T_B_H.p = config.position;
  const Pose T_B_hinge = {.p = config.position - config.radius * Eigen::Vector3d::UnitX()};
  person::Script script;
  script.duration_s = config.watched_s;
  config::Scenario result = with_script(scenario, script);
  result.script.script.start[person::kGripChannel] = 0.0;
  rendering::TwinModel& model = result.twin.model;
  model.chain = hinge(config.inertia, T_B_hinge, T_B_H);
  model.end_effector = model.chain.frame("handle");
  model.q_start = ConfigurationA::Constant(1, deflection);
  model.dofs = {{.name = "hinge",
                 .q_index = 0,
                 .limits = {.q_min = -kRange, .q_max = kRange},
                 .stiffness = stiffness,
                 .damping = config.damping}};
  rendering::check_twin_model(model);
  result.twin.name = "hinge";
  result.twin.T_B_root = T_B_hinge;
  result.limits = rendering::make_catalogue(result.device.model, model);
  experiments::set_seed(result, seed);
  return result;
}

}  // namespace

Oscillation oscillation_of(std::span<const double> signal, int swings, double rate_Hz) {
  std::vector<double> zeros, peaks;  // in samples; between zero i and i + 1
  double peak = 0.0;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    peak = std::max(peak, std::abs(signal[i]));
    if ((signal[i - 1] > 0.0) == (signal[i] > 0.0)) continue;
    if (!zeros.empty()) peaks.push_back(peak);
    zeros.push_back(static_cast<double>(i) - signal[i] / (signal[i] - signal[i - 1]));
    peak = 0.0;
    if (std::ssize(zeros) == 2 * swings + 1) break;
  }
  if (peaks.size() < 2) return {};
  const auto half_swings = static_cast<double>(peaks.size());
  const double decrement = std::log(peaks.front() / peaks.back()) / (half_swings - 1.0);
  return {.frequency_Hz = 0.5 * half_swings * rate_Hz / (zeros.back() - zeros.front()),
          .damping_ratio = decrement / std::hypot(decrement, kPi),
          .amplitude = peaks.front()};
}

Swing measure_swing(const config::Scenario& scenario, const SwingConfig& config, double stiffness,
                    double deflection, std::uint64_t seed) {
  const config::Scenario swung = prepared(scenario, config, stiffness, deflection, seed);
  const Played played = play(swung);
  const Eigen::Vector3d p_B_hinge = swung.twin.T_B_root.p;
  std::vector<double> angle;
  for (const Instant& now : played.instants) {
    const Eigen::Vector3d arm = now.T_B_H.p - p_B_hinge;
    angle.push_back(std::atan2(arm.y(), arm.x()));
  }
  const double omega = std::sqrt(stiffness / config.inertia);
  return {.true_handle = oscillation_of(angle, config.swings, swung.device.model.rate_Hz),
          .ideal_Hz = omega / (2.0 * kPi),
          .ideal_damping = config.damping / (2.0 * omega * config.inertia),
          .failure = played.failure};
}

}  // namespace hg::haptify
