// How the plant swings: the modes of the handbook, of flexible joints and of other machines.

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <complex>
#include <vector>

#include "hg/simulator/plant/plant.h"
#include "hg/simulator/test/plant_setup.h"

namespace hg::simulator {
namespace {

constexpr double kPi = std::numbers::pi;

using Signals = std::vector<std::vector<double>>;  // one per joint

// Torques of the springs after a tap of 1 ms by `tap` on the handle.
Signals ring(const PlantConfig& config, const model::ChainModel& chain, const std::string& frame,
             const PlantInput& input, const Vector6& tap, double duration) {
  Plant plant(config, chain, chain.frame(frame));
  PlantInput tapped = input;
  tapped.w_H = tap;
  for (int k = 0; k < std::lround(1e-3 / config.step); ++k) plant.step(tapped);
  Signals signals(config.manipulator.size());
  const VectorM weight = Plant(config, chain, chain.frame(frame)).truth().tau_J;
  for (int k = 0; k < std::lround(duration / config.step); ++k) {
    plant.step(input);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const auto joint = static_cast<Eigen::Index>(i);
      signals[i].push_back(plant.truth().tau_J[joint] - weight[joint]);
    }
  }
  return signals;
}

// Of the first `duration` of a signal at `frequency_Hz`, with a Hann window.
double amplitude(const std::vector<double>& signal, double step, double duration,
                 double frequency_Hz) {
  const std::size_t n = std::min<std::size_t>(signal.size(), std::lround(duration / step));
  const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * frequency_Hz * step);
  const std::complex<double> window_turn = std::polar(1.0, 2.0 * kPi / static_cast<double>(n));
  std::complex<double> phase = 1.0, window = 1.0, sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    sum += (0.5 - 0.5 * window.real()) * signal[k] * phase;
    phase *= turn;
    window *= window_turn;
  }
  return std::abs(sum);
}

// Frequency of the peak of any joint that is nearest to `expected_Hz`; 0 without one within 8 %
// that has a twentieth of what the joint has at any of `modes_Hz`.
double peak_near(const Signals& signals, double step, double duration, double expected_Hz,
                 const std::vector<double>& modes_Hz) {
  double nearest = 0.0, strongest = 0.0;
  const double df = 0.01 * expected_Hz;
  for (const std::vector<double>& signal : signals) {
    for (const double mode : modes_Hz) {
      strongest = std::max(strongest, amplitude(signal, step, duration, mode));
    }
  }
  for (const std::vector<double>& signal : signals) {
    std::vector<double> a;
    for (int k = -9; k <= 9; ++k) {
      a.push_back(amplitude(signal, step, duration, expected_Hz + k * df));
    }
    for (std::size_t k = 1; k + 1 < a.size(); ++k) {
      if (a[k] <= a[k - 1] || a[k] < a[k + 1] || a[k] < 0.01 * strongest) continue;
      const double shift = 0.5 * (a[k - 1] - a[k + 1]) / (a[k - 1] - 2.0 * a[k] + a[k + 1]);
      const double peak = expected_Hz + (static_cast<double>(k) - 9.0 + shift) * df;
      if (std::abs(peak - expected_Hz) < std::abs(nearest - expected_Hz)) nearest = peak;
    }
  }
  return nearest;
}

// The device at home without friction and nearly without damping, so that its modes stand out.
PlantConfig ringing_config() {
  PlantConfig config = reference_config();
  for (ActuatorModel& a : config.actuators) {
    a.damping *= 0.01;
    a.coulomb_friction = a.load_friction = a.viscous_friction = 0.0;
  }
  return config;
}

Vector6 slanted_tap() {
  Vector6 tap;
  tap << 20.0, 30.0, 20.0, 2.0, 3.0, 1.0;
  return tap;
}

void expect_modes(const std::vector<double>& expected_Hz, bool brakes_closed, double step,
                  double duration) {
  PlantConfig config = ringing_config();
  config.step = step;
  config.drive.dead_time = 0.0;
  const model::ChainModel chain = haptic_giant(false);
  const Signals signals =
      ring(config, chain, "handle", idle(config, brakes_closed), slanted_tap(), duration);
  for (const double expected : expected_Hz) {
    // to the digits of the handbook
    EXPECT_NEAR(peak_near(signals, step, duration, expected, expected_Hz), expected,
                std::max(0.06, 0.005 * expected))
        << expected << " Hz, brakes " << (brakes_closed ? "closed" : "open");
  }
  EXPECT_EQ(peak_near(signals, step, duration, 42.0, expected_Hz), 0.0);  // none there
}

// [HANDBOOK] 1.4
TEST(PlantModes, AreThoseOfTheHandbookWithClosedBrakes) {
  expect_modes({4.1, 9.0, 11.4, 12.4}, true, 0.05e-3, 4.0);
  expect_modes({77.0, 252.0}, true, 0.01e-3, 0.4);
}

TEST(PlantModes, AreThoseOfTheHandbookWithFreeMotors) {
  expect_modes({15.0, 17.1, 20.6, 21.0}, false, 0.05e-3, 4.0);
  expect_modes({81.0, 253.0}, false, 0.01e-3, 0.4);
}

// [HANDBOOK] 4.4: the step itself damps by omega h / 2; 1.2 % of critical at 15 Hz
TEST(PlantModes, TheStepDampsAsTheHandbookSays) {
  const double omega = 2.0 * kPi * 15.0;
  const PlantConfig config = one_joint_config(bare_actuator(1.0, 2.0 * omega * omega));
  const Signals signals =
      ring(config, one_joint(2.0), "tip", idle(config, true), Vector6(5.0 * Vector6::Unit(5)), 1.0);
  std::vector<double> peaks;
  for (std::size_t k = 1; k + 1 < signals[0].size(); ++k) {
    const double here = signals[0][k];
    if (here > signals[0][k - 1] && here >= signals[0][k + 1]) peaks.push_back(here);
  }
  ASSERT_GT(peaks.size(), 11u);
  const double damping = std::log(peaks[0] / peaks[10]) / (10.0 * 2.0 * kPi);
  EXPECT_NEAR(damping, 0.0118, 0.0002);
}

// A mass on a slide with an actuator, itself on a slide that gives way: two masses on two springs.
TEST(PlantModes, AFlexibleJointLowersThemAsPredicted) {
  const std::string parts =
      joint("give", "prismatic", "base", "carriage", "1 0 0") + body("carriage", 3.0, 0.1) +
      joint("slide", "prismatic", "carriage", "tip", "1 0 0") + body("tip", 2.0, 0.1);
  const model::ChainModel chain = chain_of(parts, false);
  constexpr double kJoint = 8000.0, kGive = 20000.0;  // N/m
  PlantConfig config = one_joint_config(bare_actuator(1.0, kJoint));
  config.step = 0.02e-3;
  config.manipulator = {1};
  config.flexible = {{.joint = 0, .stiffness = kGive}};
  const Signals signals =
      ring(config, chain, "tip", idle(config, true), Vector6(10.0 * Vector6::Unit(0)), 4.0);

  Eigen::Matrix2d M, K;
  M << 5.0, 2.0, 2.0, 2.0;
  K << kGive, 0.0, 0.0, kJoint;
  const Eigen::Matrix2d A = M.inverse() * K;
  const double mean = 0.5 * A.trace(), half = std::sqrt(mean * mean - A.determinant());
  const double rigid = std::sqrt(kJoint / 2.0) / (2.0 * kPi);
  const std::vector<double> modes_Hz = {std::sqrt(mean - half) / (2.0 * kPi),
                                        std::sqrt(mean + half) / (2.0 * kPi)};
  for (const double mode : modes_Hz) {
    EXPECT_NEAR(peak_near(signals, config.step, 4.0, mode, modes_Hz), mode, 0.003 * mode);
  }
  EXPECT_LT(modes_Hz[0], 0.9 * rigid);
  EXPECT_EQ(peak_near(signals, config.step, 4.0, rigid, modes_Hz), 0.0);
}

TEST(PlantModes, AFlexibleFrameBelowTheGantrySagsAndGivesWayToItsDrive) {
  // the frame bends about y at the ceiling, the gantry drives along it, a pendulum hangs from it
  const std::string parts =
      joint("frame", "revolute", "base", "beam", "0 1 0") + body("beam", 50.0, 20.0) +
      joint("gantry", "prismatic", "beam", "trolley", "1 0 0", "0 0 0.5") +
      body("trolley", 20.0, 1.0) + joint("arm", "revolute", "trolley", "upper", "0 1 0") +
      body("upper", 0.1, 0.01) + joint("bend", "revolute", "upper", "tip", "0 1 0", "0.4 0 0") +
      body("tip", 4.0, 0.05);
  const model::ChainModel chain = chain_of(parts, true);
  model::ChainData judge(chain);
  PlantConfig config = one_joint_config(bare_actuator(1.0, 5000.0));
  config.gantry = {1};
  config.manipulator = {2};
  config.flexible = {{.joint = 3, .stiffness = 300.0, .damping = 0.5},
                     {.joint = 0, .stiffness = 1e5, .damping = 50.0}};
  config.q_p_start = VectorP::Constant(1, 0.7);
  Plant plant(config, chain, chain.frame("tip"));

  // starts bent by the weight, and rests
  judge.update(plant.q(), plant.dq());
  EXPECT_GT(plant.q()[0], 1e-4);
  EXPECT_NEAR(1e5 * plant.q()[0], -judge.gravity()[0], 1e-6);
  EXPECT_NEAR(300.0 * plant.q()[3], -judge.gravity()[3], 1e-6);
  EXPECT_NEAR(plant.truth().tau_J[0], judge.gravity()[2], 1e-6);
  PlantInput input = idle(config, true);
  for (int k = 0; k < 4000; ++k) plant.step(input);
  EXPECT_LT(plant.dq().norm(), 1e-9);

  // the drive shakes the frame, and all equations hold
  input.dq_p_command[0] = 0.5;
  double bent = plant.q()[0], least = bent, most = bent;
  for (int k = 0; k < 4000; ++k) {
    plant.step(input);
    ASSERT_LT(plant.residual(), 1e-12);
    least = std::min(least, plant.q()[0]);
    most = std::max(most, plant.q()[0]);
  }
  EXPECT_GT(most - least, 1e-4);
}

// A drum that lifts: K in N/m, theta in m
TEST(PlantModes, PrismaticJointsAreSpringsUnderLoad) {
  const std::string parts =
      joint("lift", "prismatic", "base", "tip", "0 0 1") + body("tip", 5.0, 0.1);
  const model::ChainModel chain = chain_of(parts, true);
  ActuatorModel actuator = bare_actuator(2.0, 20'000.0);
  PlantConfig config = one_joint_config(actuator);
  config.step = 0.02e-3;
  const Plant plant(config, chain, chain.frame("tip"));
  EXPECT_NEAR(plant.truth().theta_m[0] - plant.truth().q_m[0], 5.0 * 9.81 / 20'000.0, 1e-12);
  const Vector6 tap = 10.0 * Vector6::Unit(2);
  const double locked = std::sqrt(20'000.0 / 5.0) / (2.0 * kPi);
  EXPECT_NEAR(peak_near(ring(config, chain, "tip", idle(config, true), tap, 3.0), config.step, 3.0,
                        locked, {locked}),
              locked, 0.003 * locked);

  PlantInput held = idle(config, false);
  held.tau_command[0] = 5.0 * 9.81;
  const double open = std::sqrt(20'000.0 / 5.0 + 20'000.0 / 2.0) / (2.0 * kPi);
  EXPECT_NEAR(peak_near(ring(config, chain, "tip", held, tap, 3.0), config.step, 3.0, open, {open}),
              open, 0.003 * open);
}

TEST(PlantModes, SevenJointsWithoutAGantryFallAndAreCaught) {
  std::string parts, parent = "base";
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) {
    const bool is_upright = parent == "base" || parent == "b" || parent == "d" || parent == "f";
    parts +=
        joint(parent + name, "revolute", parent, name, is_upright ? "0 0 1" : "0 1 0", "0.1 0 0.2");
    parts += body(name, 3.0, 0.02);
    parent = name;
  }
  const model::ChainModel chain = chain_of(parts, true);
  PlantConfig config;
  config.q_m_start = VectorM::Constant(7, 0.3);
  for (int i = 0; i < 7; ++i) {
    config.manipulator.push_back(i);
    config.actuators.push_back(reference_actuators()[i / 2]);
    config.end_stops.push_back({0.0, 0.6});
  }
  Plant plant(config, chain, chain.frame("g"));
  const PlantInput input = idle(config, false);
  double fastest = 0.0;
  for (int k = 0; k < 40'000; ++k) {
    plant.step(input);
    fastest = std::max(fastest, plant.dq().lpNorm<Eigen::Infinity>());
    ASSERT_LT(plant.residual(), 1e-10);  // Nm, of 1e4 Nm in the stops
    ASSERT_TRUE(plant.forces().is_exact);
  }
  EXPECT_GT(fastest, 0.3);
  EXPECT_LT(plant.dq().norm(), 1e-3);
  EXPECT_FALSE(plant.forces().tau_stop.isZero());
}

}  // namespace
}  // namespace hg::simulator
