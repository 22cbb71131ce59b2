#include "hg/check/light_twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hg/check/drive_loop.h"
#include "hg/check/stiffness.h"
#include "hg/core/error.h"
#include "hg/core/stacked.h"
#include "hg/handle_loop/loop_device.h"
#include "hg/scenario/start_posture.h"

namespace hg::check {
namespace {

using person::HandImpedance;
using person::HandPreset;

// In front of drives that follow positions: along the worst axis of B.
double lightest_before_drives(const config::SimulatedDeviceConfig& device, const VectorPM& q,
                              double damping, const HandImpedance& hand) {
  double lightest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const DriveLoop loop(device, q, Eigen::Vector3d::Unit(axis),
                         {.stiffness = hand.stiffness[axis],
                          .damping = hand.damping[axis],
                          .mass = hand.mass[axis],
                          .grip_stiffness = hand.grip_stiffness,
                          .grip_damping = hand.grip_damping});
    lightest = std::max(lightest, loop.lightest_mass(0, damping));
  }
  return lightest;
}

std::string to_text(double mass) {
  return std::isfinite(mass) ? fmt::format("{:.2g} kg", mass) : "none";
}

}  // namespace

std::vector<double> lightest_bodies(const config::SimulatedDeviceConfig& device,
                                    const config::Twin& twin, double damping,
                                    std::span<const HandImpedance> hands) {
  std::vector<double> lightest;
  try {
    const scenario::Start start = scenario::find_start(device, twin);
    const VectorPM q = stacked(start.q_p, start.q_m);
    const config::PlantKind plant = plant_of(device);
    const bool has_torques = plant == config::PlantKind::kTorqueDrives &&
                             device.control.method == tracking::Method::kModal &&
                             !device.estimation.wrench.has_imu;
    for (const HandImpedance& hand : hands) {
      if (plant == config::PlantKind::kPositionDrives) {
        lightest.push_back(lightest_before_drives(device, q, damping, hand));
      } else if (has_torques) {
        lightest.push_back(handle_loop::lightest_mass(handle_loop::device_of(device),
                                                      handle_loop::simulated(device),
                                                      {.damping = damping}, hand, q));
      }
    }
  } catch (const SetupError&) {  // what is wrong with the start is stated itself
    return {};
  }
  return lightest;
}

Findings inspect_light_twin(const config::Scenario& scenario) {
  Collector out(scenario.sources, scenario.places);
  const FeltTwin felt = felt_twin(scenario.twin);
  if (!can_be_pushed(felt.mass.ub)) return {};  // what is held along an axis swings less
  std::vector<HandImpedance> hands = {person::hand(HandPreset::kRelaxed),
                                      person::hand(HandPreset::kNormal),
                                      person::hand(HandPreset::kStiff)};
  const bool has_hand = scenario.person == person::PersonKind::kScript;
  if (has_hand) hands.push_back(scenario.script.hand);
  const std::vector<double> lightest =
      lightest_bodies(scenario.device, scenario.twin, felt.damping, hands);
  if (lightest.empty()) return {};
  const std::string all = fmt::format("relaxed {}, normal {}, stiff {}", to_text(lightest[0]),
                                      to_text(lightest[1]), to_text(lightest[2]));
  const std::string what = fmt::format("lightest twin that does not shake in a hand: {}", all);
  if (!has_hand || felt.mass.lb >= lightest.back()) {
    out.add(Severity::kNote, "twin", what, "");
    return std::move(out.findings);
  }
  out.add(Severity::kWarning, "twin",
          fmt::format("{:.2g} kg at the handle shake in the hand of this script below {}; {}",
                      felt.mass.lb, to_text(lightest.back()), what),
          "give the twin more mass or damping; a force sensor with an accelerometer behind it "
          "(estimation.has_imu) renders less");
  return std::move(out.findings);
}

}  // namespace hg::check
