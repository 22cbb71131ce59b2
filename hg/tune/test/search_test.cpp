#include "hg/tune/search.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hg/config/torque_loop.h"
#include "hg/core/linear_algebra.h"
#include "hg/scenario/assembly.h"
#include "hg/tune/tuned_device.h"

namespace hg::tune {
namespace {

TuningProblem problem_of(int postures) {
  const config::SimulatedDeviceConfig device =
      config::load_simulated_device("models/haptic_giant/device.yaml");
  TuningProblem problem = {.device = device_of(device),
                           .noise = noise_of(device),
                           .plant = simulated(device),
                           .friction = unexpected_friction(device),
                           .postures = config::random_postures(device.model, postures, 1),
                           .felt_postures = 1};
  problem.friction_most_N = figures_of(problem, problem.device).friction_N;
  return problem;
}

Values with(const TuningProblem& problem, std::string_view key, double value) {
  Values values = values_of(problem.device);
  for (std::size_t i = 0; i < knobs().size(); ++i) {
    if (knobs()[i].key == key) values[i] = value;
  }
  return values;
}

TEST(Knobs, GiveBackWhatTheyTook) {
  const LoopDevice device = problem_of(1).device;
  const Values values = 0.9 * values_of(device);
  EXPECT_LT((values_of(with_values(device, values)) - values).norm(), 1e-12);
}

// a low-pass of 0 is none: nothing that the search proposes, but what the device has
TEST(Search, JudgesThePresentLoopAsItIs) {
  TuningProblem problem = problem_of(1);
  problem.device.loop.config.stiff_low_pass_Hz = 0.0;
  const Figures as_it_is = figures_of(problem, problem.device);
  const Figures within_range =
      figures_of(problem, with_values(problem.device, values_of(problem.device)));
  EXPECT_GT(std::abs(as_it_is.vibration / within_range.vibration - 1.0), 0.05);
  problem.most_rounds = 1;
  const TuningResult result = search(problem, {1.0}, {});
  EXPECT_EQ(result.before.figures.vibration, as_it_is.vibration);
  EXPECT_NEAR(values_at(place_of(values_of(problem.device)))[5], knobs()[5].most, 1e-9);
}

TEST(Knobs, TakeALoopThatIsSlowerThanTheirRange) {
  LoopDevice slow = problem_of(1).device;
  slow.loop.config.loop.latency = 8e-3;
  const LoopDevice taken = with_values(slow, values_of(slow));
  EXPECT_NEAR(taken.loop.config.poles.w0, 0.265 / 8.5e-3, 1e-9);
}

TEST(Knobs, TakeNoMoreThanLatencyAndRateAllow) {
  const TuningProblem problem = problem_of(1);
  const LoopDevice fast =
      with_values(problem.device, with(problem, "rotor_pole_rad_per_s", 1000.0));
  EXPECT_LT(fast.loop.config.poles.w0, 0.2651 / 1.5e-3);
  const LoopDevice wild = with_values(problem.device, with(problem, "flatness_Hz", 1e6));
  EXPECT_LT(wild.loop.config.flatness_Hz, tracking::largest_flatness_Hz(1000.0));
}

// docs/concepts/control.md: what the notes had was unstable with light rotors
TEST(Demands, RefuseTheDampingOfTheNotes) {
  const TuningProblem problem = problem_of(30);
  const Demands demands = demands_of(problem);
  const auto failures = [&](const LoopDevice& device) {
    int count = 0;
    for (std::size_t i = 0; i < problem.postures.size(); ++i) {
      for (const Case& one : demands.cases(i)) {
        if (one.grasp < 0 && demands.excess(device, one) > 0.0) ++count;
      }
    }
    return count;
  };
  EXPECT_EQ(failures(problem.device), 0);
  EXPECT_GT(failures(with_values(problem.device, with(problem, "spring_damping", 0.5))), 0);
}

// the body that is shipped, in hands up to 2000 N/m and with 1.5 times the latency
TEST(Demands, EveryHandHoldsTheShippedBodyInEveryPosture) {
  const TuningProblem problem = problem_of(20);
  for (const Deviation& deviation : deviations_in_hand(problem.device.loop)) {
    for (const Grasp& grasp : grasps(problem.body)) {
      LoopDevice device = problem.device;
      device.loop.config.flatness_Hz *= deviation.follower;
      double worst = 0.0;
      for (const Eigen::VectorXd& q : problem.postures) {
        worst = std::max(
            worst,
            spectral_radius(linearise(device, deviation.plant, problem.body, grasp.hand, {}, q).A));
      }
      EXPECT_LT(worst, kHandRadius) << grasp.what << ", " << deviation.what;
    }
  }
}

TEST(Demands, AreHarderForALighterBody) {
  const TuningProblem problem = problem_of(1);
  const auto worst = [&](double mass) {
    const Demands demands(problem.device.loop, {.mass = mass}, problem.postures);
    double largest = 0.0;
    for (const Case& one : demands.cases(0)) {
      if (one.grasp >= 0) largest = std::max(largest, demands.radius(problem.device, one));
    }
    return largest;
  };
  EXPECT_GT(worst(0.1), worst(6.0) + 0.03);
}

// From a loop that is late to one that is not.
TEST(Search, FindsWhatWasTakenAway) {
  TuningProblem problem = problem_of(3);
  problem.device = with_values(problem.device, with(problem, "motor_low_pass_Hz", 400.0));
  problem.device = with_values(problem.device, with(problem, "wrench_lead_s", 0.0));
  problem.most_rounds = 15;
  const double limit = 0.04;
  const TuningResult result = search(problem, {limit}, {});
  const Candidate& found = result.front.front();
  EXPECT_TRUE(result.proofs.front().holds());
  EXPECT_LT(found.figures.vibration, 1.01 * limit);
  EXPECT_LT(found.figures.distortion, 0.8 * result.before.figures.distortion);
  EXPECT_LT(found.figures.friction_N, 1.01 * problem.friction_most_N);
  for (const double value : found.values) {  // as a file will have them
    if (value == 0.0) continue;
    const double digits = value / std::pow(10.0, std::floor(std::log10(value)) - 2.0);
    EXPECT_NEAR(digits, std::round(digits), 1e-6);
  }
  // what a file says gives the figures of the report
  Values in_file = found.values;
  for (double& value : in_file) value = std::stod(fmt::format("{:g}", value));
  const Figures again = figures_of(problem, with_values(problem.device, in_file));
  EXPECT_NEAR(again.distortion, found.figures.distortion, 1e-3 * found.figures.distortion);
}

}  // namespace
}  // namespace hg::tune
