#include "hg/check/light_twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/check/drive_loop.h"
#include "hg/check/stiffness.h"
#include "hg/config/twin.h"
#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"
#include "hg/core/stacked.h"
#include "hg/handle_loop/loop_device.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/start_posture.h"

namespace hg::check {
namespace {

using person::HandImpedance;
using person::HandPreset;

// What the twin is at its handle where it is lightest; empty where something holds it in a
// direction.
std::optional<handle_loop::Body> free_body(const config::Twin& twin) {
  constexpr double kStuck = 1e-6;  // of the largest mobility
  const rendering::TwinModel& model = twin.model;
  model::ChainData chain(model.chain);
  chain.update(model.q_start, VectorA::Zero(chain.model().nv()));
  const Eigen::MatrixXd J =
      model.felt_scale.cwiseSqrt().asDiagonal() * chain.jacobian(model.end_effector);
  const Eigen::MatrixXd inverse_mass = inverse(Eigen::MatrixXd(chain.M()));
  const Eigen::MatrixXd moved = inverse_mass * J.transpose();
  const Eigen::MatrixXd mobility = J * moved;
  const auto whole = symmetric_eigen(mobility);
  if (!(whole.values[0] > kStuck * whole.values[5])) return {};
  const auto turning = symmetric_eigen(Eigen::Matrix3d(mobility.bottomRightCorner<3, 3>()));
  const Eigen::VectorXd dq = moved.rightCols<3>() * turning.vectors.col(2) / turning.values[2];
  const FeltTwin felt = felt_twin(twin);
  return handle_loop::Body{.mass = felt.mass.lb,
                           .damping = felt.damping,
                           .inertia = model.mass_scale / turning.values[2],
                           .angular_damping = felt_damping(model, dq)};
}

// In front of drives that follow positions, along the worst axis of the person.
double lightest_before_drives(const config::SimulatedDeviceConfig& device, const VectorPM& q,
                              double damping, const HandImpedance& hand) {
  model::ChainData chain(device.model.chain);
  chain.update(q, Eigen::VectorXd::Zero(q.size()));
  const double heading = config::hand_of({.R = chain.pose(device.model.handle).R}).azimuth;
  const Eigen::Matrix3d person =
      Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  double lightest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const DriveLoop loop(device, q, person.col(axis),
                         {.stiffness = hand.stiffness[axis],
                          .damping = hand.damping[axis],
                          .mass = hand.mass[axis],
                          .grip_stiffness = hand.grip_stiffness,
                          .grip_damping = hand.grip_damping});
    lightest = std::max(lightest, loop.lightest_mass(0, damping));
  }
  return lightest;
}

bool are_equal(const HandImpedance& a, const HandImpedance& b) {
  return a.stiffness == b.stiffness && a.damping == b.damping && a.mass == b.mass &&
         a.grip_stiffness == b.grip_stiffness && a.grip_damping == b.grip_damping &&
         a.angular_stiffness == b.angular_stiffness && a.angular_damping == b.angular_damping;
}

std::string to_text(double mass) {
  if (mass == 0.0) return "any";
  return std::isfinite(mass) ? fmt::format("{:.2g} kg", mass) : "none";
}

std::string advice(const config::SimulatedDeviceConfig& device, double lightest) {
  std::string text = std::isfinite(lightest) ? "give the twin more mass and inertia, or damping"
                                             : "give the twin damping";
  if (!device.estimation.wrench.has_imu) {
    text += "; a force sensor with an accelerometer (estimation.has_imu) renders less";
  }
  return text;
}

}  // namespace

std::vector<double> lightest_bodies(const config::SimulatedDeviceConfig& device,
                                    const config::Twin& twin,
                                    std::span<const HandImpedance> hands) {
  const config::PlantKind plant = plant_of(device);
  const bool follows = plant == config::PlantKind::kPositionDrives;
  const bool feels_payload = plant == config::PlantKind::kTorqueDrives &&
                             device.control.method == tracking::Method::kModal &&
                             !device.estimation.wrench.has_imu;
  const std::optional<handle_loop::Body> body = free_body(twin);
  if (!body || !(follows || feels_payload)) return {};
  VectorPM q;
  try {
    const scenario::Start start = scenario::find_start(device, twin);
    q = stacked(start.q_p, start.q_m);
  } catch (const SetupError&) {  // stated itself
    return {};
  }
  std::vector<double> lightest;
  for (const HandImpedance& hand : hands) {
    const auto known = std::ranges::find_if(
        hands.first(lightest.size()), [&](const auto& other) { return are_equal(hand, other); });
    const auto index = static_cast<std::size_t>(known - hands.begin());
    if (index < lightest.size()) {
      lightest.push_back(lightest[index]);
    } else if (follows) {
      lightest.push_back(lightest_before_drives(device, q, body->damping, hand));
    } else {
      lightest.push_back(handle_loop::lightest_mass(
          handle_loop::device_of(device), handle_loop::simulated(device), *body, hand, q));
    }
  }
  return lightest;
}

Findings inspect_light_twin(const config::Scenario& scenario) {
  Collector out(scenario.sources, scenario.places);
  std::vector<HandImpedance> hands = {person::hand(HandPreset::kRelaxed),
                                      person::hand(HandPreset::kNormal),
                                      person::hand(HandPreset::kStiff)};
  const bool has_hand = scenario.person == person::PersonKind::kScript;
  if (has_hand) hands.push_back(scenario.script.hand);
  std::vector<double> lightest;
  try {
    lightest = lightest_bodies(scenario.device, scenario.twin, hands);
  } catch (const SetupError& error) {
    out.add(Severity::kNote, "twin", fmt::format("lightest twin: not known, {}", error.what()), "");
    return std::move(out.findings);
  }
  if (lightest.empty()) return {};
  const std::string all = fmt::format(
      "lightest twin that does not shake, about: in a relaxed hand {}, in a normal one "
      "{}, in a stiff one {}",
      to_text(lightest[0]), to_text(lightest[1]), to_text(lightest[2]));
  const double mass = felt_twin(scenario.twin).mass.lb;
  if (!has_hand || mass >= lightest.back()) {
    out.add(Severity::kNote, "twin", all, "");
    return std::move(out.findings);
  }
  const std::string bound = std::isfinite(lightest.back())
                                ? "below about " + to_text(lightest.back())
                                : std::string("whatever they weigh");
  out.add(Severity::kWarning, "twin",
          fmt::format("{:.2g} kg at the handle shake in the hand of this script, {}; {}", mass,
                      bound, all),
          advice(scenario.device, lightest.back()));
  return std::move(out.findings);
}

}  // namespace hg::check
