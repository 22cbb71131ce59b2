#include "hg/handle_loop/handle_loop.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "hg/config/simulation/scenario.h"
#include "hg/core/linear_algebra.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/free_space.h"
#include "hg/experiments/haptify/response.h"
#include "hg/experiments/stability_map.h"
#include "hg/scenario/assembly.h"
#include "hg/tune/feel.h"
#include "hg/tune/tuned_device.h"

namespace hg::tune {
namespace {

// The middle of the workspace, where experiments/haptify and the stability map measure.
config::Scenario walk() {
  config::Scenario scenario = config::load_scenario("models/scenarios/walk.yaml");
  scenario.twin.model.q_start.head<3>() = haptify::ResponseConfig{}.position;
  return scenario;
}

Eigen::VectorXd posture_of(const config::Scenario& scenario) {
  const scenario::Start start = scenario::find_start(scenario.device, scenario.twin);
  Eigen::VectorXd q(start.q_p.size() + start.q_m.size());
  q << start.q_p, start.q_m;
  return q;
}

HandleLoop loop_of(const config::Scenario& scenario, const Body& body,
                   const person::HandImpedance& hand) {
  return linearise(device_of(scenario.device), simulated(scenario.device), body, hand,
                   noise_of(scenario.device), posture_of(scenario));
}

TEST(Resolvent, SolvesLikeADenseDecomposition) {
  std::srand(1);
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(17, 17), B = Eigen::MatrixXd::Random(17, 2),
                        C = Eigen::MatrixXd::Random(3, 17);
  Resolvent resolvent(A);
  for (const std::complex<double> z : {std::polar(1.0, 0.3), std::polar(2.0, 2.0)}) {
    const Eigen::MatrixXcd dense =
        (z * Eigen::MatrixXcd::Identity(17, 17) - A.cast<std::complex<double>>()).inverse();
    resolvent.at(z);
    EXPECT_LT((resolvent.solve(B) - dense * B).norm(), 1e-9);
    EXPECT_LT((resolvent.solve_transposed(C) - C * dense).norm(), 1e-9);
  }
}

// The judge is the simulation, which shares no line with the linear loop but the controller: with
// friction, noise, quantisation and a gantry that moves.
TEST(HandleLoop, AgreesWithTheSimulation) {
  const config::Scenario scenario = walk();
  const HandleLoop loop = loop_of(scenario, {}, person::HandImpedance{});
  const Feel said = feel(loop, {}, unexpected_friction(scenario.device));
  Resolvent resolvent(loop.A);
  haptify::ResponseConfig pushes;
  pushes.frequency_Hz = {kLatencyAt, 5, 8, 12,
                         16};  // beyond, 10 N move the joints less than friction bends
  pushes.periods = 3;
  pushes.least_s = 0.6;
  for (int axis = 0; axis < 2; ++axis) {
    const haptify::Response shown = haptify::measure_response(scenario, pushes, axis, 1);
    ASSERT_EQ(shown.failure, "");
    for (const haptify::Answer& answer : shown.answers) {
      const std::complex<double> felt =
          felt_over_body(resolvent, loop, {}, answer.frequency_Hz)[axis];
      const std::complex<double> ratio = answer.impedance / answer.twin;
      EXPECT_LT(std::abs(felt - ratio), 0.1 * std::abs(ratio))
          << "axis " << axis << ", " << answer.frequency_Hz << " Hz";
    }
    const haptify::Answer& slow = shown.answers.front();  // at kLatencyAt
    const double latency_s =
        std::arg(slow.impedance / slow.twin) / (2.0 * std::numbers::pi * slow.frequency_Hz);
    EXPECT_NEAR(said.latency_s[axis], latency_s, 1e-3);
  }
  const haptify::FreeSpace walked = haptify::measure_free_space(scenario, {.duration_s = 8.0}, 1);
  ASSERT_EQ(walked.failure, "");
  EXPECT_NEAR(said.vibration, walked.vibration_rms, 0.25 * walked.vibration_rms);
  EXPECT_NEAR(said.centroid_Hz, walked.centroid_Hz, 0.1 * walked.centroid_Hz);
}

// How a kick that saturates nothing dies out, on a machine without friction.
TEST(HandleLoop, IsStableWhereTheSimulationIs) {
  config::Scenario scenario = walk();
  experiments::take_friction(scenario.device.model);
  experiments::StabilityConfig config;
  config.kick.force = 0.3;
  person::HandImpedance hand = person::hand(person::HandPreset::kStiff);
  hand.tremor_rms = 0.0;
  for (const auto& [mass, is_stable] : {std::pair{0.2, false}, {0.6, true}}) {
    const experiments::KickOutcome shown = experiments::kick(scenario, config, hand, mass, 4.0);
    EXPECT_EQ(experiments::is_stable(shown.verdict), is_stable) << mass;
    EXPECT_EQ(spectral_radius(loop_of(scenario, {.mass = mass}, hand).A) < 1.0, is_stable) << mass;
  }
}

TEST(HandleLoop, ALateWrenchIsFeltLaterAndLessClearly) {
  const config::Scenario scenario = walk();
  LoopDevice late = device_of(scenario.device);
  late.wrench.delay_s += 3e-3;
  const auto felt = [&](const LoopDevice& device) {
    return feel(linearise(device, simulated(scenario.device), {}, person::HandImpedance{},
                          noise_of(scenario.device), posture_of(scenario)),
                {}, unexpected_friction(scenario.device));
  };
  const Feel now = felt(device_of(scenario.device)), then = felt(late);
  // a little more than the 3 ms, since the arm bends meanwhile
  const double later_s = then.largest_latency_s() - now.largest_latency_s();
  EXPECT_GT(later_s, 3e-3);
  EXPECT_LT(later_s, 4e-3);
  EXPECT_LT(then.least_transparency_Hz(), 0.7 * now.least_transparency_Hz());
  EXPECT_GT(then.distortion, 1.3 * now.distortion);
}

TEST(HandleLoop, NoiseComesFromWhatIsNoisyAndNothingElse) {
  const config::Scenario scenario = walk();
  const auto vibration = [&](const Noise& noise) {
    return feel(linearise(device_of(scenario.device), simulated(scenario.device), {},
                          person::HandImpedance{}, noise, posture_of(scenario)),
                {}, unexpected_friction(scenario.device))
        .vibration;
  };
  EXPECT_EQ(vibration({}), 0.0);
  const double of_force = vibration({.force = 1e-3});
  EXPECT_GT(of_force, 0.0);
  EXPECT_NEAR(vibration({.force = 2e-3}), 2.0 * of_force, 1e-9);
}

// the sensor's mean and delay fall between samples then
TEST(HandleLoop, HasTheNoiseOfTheWrenchAtOtherRates) {
  const config::Scenario scenario = walk();
  const auto vibration = [&](double rate_Hz) {
    config::SimulatedDeviceConfig device = scenario.device;
    device.control.flatness_Hz = 40.0;
    device.model.rate_Hz = rate_Hz;
    return feel(linearise(device_of(device), simulated(device), {}, person::HandImpedance{},
                          {.force = 2.5e-3}, posture_of(scenario)),
                {}, unexpected_friction(device))
        .vibration;
  };
  EXPECT_GT(vibration(400.0), 1e-3);
  EXPECT_NEAR(vibration(2000.0), vibration(1000.0), 0.35 * vibration(1000.0));
}

// dt d / m = 2.7: with the damper as it stands the body would be thrown to and fro
TEST(HandleLoop, AStrongDamperDoesNotRing) {
  const config::Scenario scenario = walk();
  const Body damped = {.mass = 0.3, .damping = 800.0};
  EXPECT_LT(spectral_radius(loop_of(scenario, damped, person::HandImpedance{}).A), 1.0);
}

TEST(Device, WithoutNoiseOrAccelerometerIsRefused) {
  config::Scenario silent = walk(), blind = walk();
  silent.device.simulation.sensors.wrench.force_noise = 0.0;
  EXPECT_THROW(device_of(silent.device), SetupError);
  blind.device.estimation.wrench.has_imu = false;
  EXPECT_THROW(device_of(blind.device), SetupError);
}

TEST(Device, OneWhoseDrivesFollowPositionsIsRefused) {
  config::Scenario scenario = walk();
  scenario.device.control.method = tracking::Method::kDrives;
  EXPECT_THROW(device_of(scenario.device), SetupError);
}

}  // namespace
}  // namespace hg::tune
