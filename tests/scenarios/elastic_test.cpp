/// The scenarios in closed loop with the device as it ships: series elastic joints whose model is
/// wrong, friction, latency, sensors with all their errors, and hands of different people.

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/simulator/person/hand.h"
#include "tests/scenarios/trace.h"

namespace hg {
namespace {

// what the true state of the links may do
constexpr double kLengthMax = 1e-3;  // m beyond a limit
constexpr double kAngleMax = 2e-3;   // rad beyond a limit
constexpr double kErrorMax = 2e-3;   // rad off the reference

struct Case {
  const char* scenario;
  double rate_Hz;
  std::optional<person::HandPreset> hand;  // none: as the script says
  std::uint64_t seed;
};

std::string name_of(const Case& c) {
  const char* hand = "own";
  if (c.hand == person::HandPreset::kRelaxed) hand = "relaxed";
  if (c.hand == person::HandPreset::kNormal) hand = "normal";
  if (c.hand == person::HandPreset::kStiff) hand = "stiff";
  return std::string(c.scenario) + "_" + hand + "_" + std::to_string(std::lround(c.rate_Hz)) +
         "_Hz_seed_" + std::to_string(c.seed);
}

config::Scenario scenario_of(const Case& c) {
  config::Scenario scenario = shipped(c.scenario, c.rate_Hz);
  scenario.device.simulation.seed = scenario.device.simulation.sensors.seed = c.seed;
  if (c.hand) scenario.script.hand = person::hand(*c.hand);
  // the script of the excavator presses against springs: it needs a hand of 350 N/m
  const bool is_soft = c.hand && c.hand != person::HandPreset::kStiff;
  if (is_soft && std::string(c.scenario) == "excavator") scenario.events.clear();
  return scenario;
}

void expect_limits_held_in_truth(const ScenarioRun& run) {
  const std::vector<double>& excess = run.summary().truth().worst_excess();
  for (std::size_t i = 0; i < excess.size(); ++i) {
    const LimitInfo& limit = run.scenario().limits[i];
    EXPECT_LT(excess[i], limit.is_angle ? kAngleMax : kLengthMax) << limit.name;
  }
}

class ElasticDevice : public ::testing::TestWithParam<Case> {};

std::vector<Case> cases() {
  using person::HandPreset;
  std::vector<Case> all;
  for (const char* scenario : {"door", "excavator", "free_space"}) {
    for (const double rate_Hz : {1000.0, 2000.0}) {
      const std::uint64_t seed = rate_Hz > 1000.0 ? 2 : 1;
      all.push_back({scenario, rate_Hz, {}, 3 - seed});
      for (const HandPreset hand : {HandPreset::kRelaxed, HandPreset::kNormal, HandPreset::kStiff})
        all.push_back({scenario, rate_Hz, hand, seed});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Shipped, ElasticDevice, ::testing::ValuesIn(cases()),
                         [](const auto& test) { return name_of(test.param); });

TEST_P(ElasticDevice, RunsTheScenarioWithinItsTolerances) {
  ScenarioRun run(scenario_of(GetParam()));
  run.play();
  expect_sound(run);
  expect_limits_held_in_truth(run);
  const analysis::TruthSummary& reality = run.summary().truth();
  ASSERT_TRUE(reality.is_known());
  EXPECT_LT(reality.max_joint_error(), kErrorMax) << "m" << reality.worst_joint() + 1;
  EXPECT_LT(reality.max_hand_distance(), kSyncMax);
  EXPECT_EQ(reality.clamped_cycles(), 0u);
}

std::vector<std::uint64_t> hashes_of(const config::Scenario& scenario, double seconds) {
  std::vector<std::uint64_t> hashes;
  ScenarioRun run(scenario);
  run.play([&](const Sample& sample) { hashes.push_back(sample.record.state_hash); }, seconds);
  return hashes;
}

// The gantry carries the arm into corners at full speed, and a hand of 100 N pulls it along:
// nothing but a common way to rest keeps all limits.
TEST(ElasticThrow, LimitsThatBrakeTogetherHoldInCorners) {
  for (const unsigned seed : {1U, 2U}) {
    SCOPED_TRACE(seed);
    config::Scenario scenario =
        scenario::load({.scenario = "models/stress/throw.yaml", .law = "together"});
    scenario.device.simulation.seed = scenario.device.simulation.sensors.seed = seed;
    ScenarioRun run(scenario);
    run.play();
    EXPECT_EQ(run.summary().fault().code, FaultCode::kNone)
        << to_string(run.summary().fault().code);
    EXPECT_EQ(run.quality().allocations, 0u);
    expect_limits_held_in_truth(run);
  }
}

// A wrist that turns fast passes near its own forearm all the time. That is no collision ahead, and
// the law does not let it become one.
class ElasticFastHand : public testing::TestWithParam<const char*> {};

TEST_P(ElasticFastHand, OfAnArmMeetsNoCollisionAhead) {
  bool was_held = false;
  for (const char* file : {"tests/scenarios/fast/fr3.yaml", "tests/scenarios/fast/ur5e.yaml"}) {
    SCOPED_TRACE(file);
    const config::Scenario scenario = scenario::load({.scenario = file, .law = GetParam()});
    ASSERT_TRUE(scenario.device.model.keeps_apart);
    ScenarioRun run(scenario);
    bool is_near = false;
    const std::size_t limit = scenario.device.model.limit_count() - 1;
    run.play([&](const Sample& sample) {
      is_near = is_near || sample.record.limits[limit].to_lower < 0.03;
      was_held = was_held || sample.record.limits[limit].state == LimitState::kLower;
    });
    EXPECT_EQ(run.summary().fault().code, FaultCode::kNone)
        << to_string(run.summary().fault().code);
    EXPECT_EQ(run.quality().allocations, 0u);
    EXPECT_TRUE(is_near);
    expect_limits_held_in_truth(run);
  }
  EXPECT_TRUE(was_held);
}

INSTANTIATE_TEST_SUITE_P(Laws, ElasticFastHand, testing::Values("together", "gauss"));

TEST(ElasticSeeds, TheSameSeedGivesTheSameBitsAndAnotherSeedOthers) {
  constexpr double kSeconds = 3.0;
  const Case first = {"door", 1000.0, {}, 1};
  Case second = first;
  second.seed = 2;
  const std::vector<std::uint64_t> hashes = hashes_of(scenario_of(first), kSeconds);
  EXPECT_GT(hashes.size(), 2900u);
  EXPECT_EQ(hashes, hashes_of(scenario_of(first), kSeconds));
  EXPECT_NE(hashes.back(), hashes_of(scenario_of(second), kSeconds).back());
}

constexpr int kStuck = 3;                                                    // m4
constexpr double kSticksFrom = 0.7 + 1.3, kSticksUntil = kSticksFrom + 0.3;  // s

// A device whose joint m4 sticks for 0.3 s: its drive holds it, on any command.
class StickingDevice final : public device::Device {
 public:
  StickingDevice(simulator::Simulation simulation, double rate_Hz)
      : simulation_(std::move(simulation)), rate_Hz_(rate_Hz) {}

  void read(SensorFrame& sensors) noexcept override { sensors = simulation_.sensors(); }
  const Truth* truth() const noexcept override { return &simulation_.truth(); }
  void write(const CommandFrame& command) noexcept override {
    CommandFrame altered = command;
    const Truth& now = simulation_.truth();
    const double time_s = static_cast<double>(periods_++) / rate_Hz_;
    const bool sticks = time_s >= kSticksFrom && time_s < kSticksUntil;
    if (sticks && !stuck_) held_ = now;
    stuck_ = sticks;
    if (sticks && now.theta_m.size() > 0) {
      altered.tau_m[kStuck] = now.tau_J[kStuck] +
                              8000.0 * (held_.theta_m[kStuck] - now.theta_m[kStuck]) -
                              70.0 * now.dtheta_m[kStuck];
    } else if (sticks) {
      altered.q_m[kStuck] = held_.q_m[kStuck];
      altered.dq_m[kStuck] = altered.ddq_m[kStuck] = 0.0;
    }
    simulation_.step(altered);
  }

 private:
  simulator::Simulation simulation_;
  double rate_Hz_;
  std::uint64_t periods_ = 0;
  bool stuck_ = false;
  Truth held_;
};

// The hand raises the free body, with up to 45 N where m4 does not go along; [C] 6.
config::Scenario raising() {
  config::Scenario scenario = shipped("free_space");
  scenario.events.clear();
  scenario.script.script.segments = {
      {.start_s = 1.0, .duration_s = 1.0, .channel = 2, .blend = person::Blend::kBy, .value = 0.3}};
  scenario.script.script.duration_s = scenario.duration_s = 4.0;
  scenario.script.hand = person::hand(person::HandPreset::kNormal);
  return scenario;
}

struct StuckJoint {
  double stuck_error = 0.0;  // largest of m4's reference while it sticks, rad
  double moved = 0.0;        // of m4 while it sticks, rad
  double pull = 0.0;         // largest force of the hand while it sticks, N
  double released = 0.0;     // largest acceleration of the true handle afterwards, m/s^2
  double jump = 0.0;  // largest change of m4's reference speed in a cycle afterwards, rad/s^2
  double hand = 0.0;  // largest distance of twin and true handle, m
  std::uint64_t clamped = 0;
  FaultCode fault = FaultCode::kNone;
};

StuckJoint stuck_joint(const config::Scenario& scenario) {
  const double rate_Hz = scenario.device.model.rate_Hz;
  ScenarioRun run(scenario,
                  std::make_unique<StickingDevice>(scenario::make_simulation(scenario), rate_Hz));
  StuckJoint result;
  double stuck_at = 0.0, last_dq = 0.0;
  run.play([&](const Sample& sample) {
    const CycleRecord& record = sample.record;
    const double dq = record.reference.dq_m[kStuck];
    if (record.time_s <= kSticksFrom) {
      stuck_at = sample.truth.q_m[kStuck];
    } else if (record.time_s < kSticksUntil) {
      const double error = std::abs(record.reference.q_m[kStuck] - sample.truth.q_m[kStuck]);
      result.stuck_error = std::max(result.stuck_error, error);
      result.moved = std::max(result.moved, std::abs(sample.truth.q_m[kStuck] - stuck_at));
      result.pull = std::max(result.pull, sample.truth.w_H.head<3>().norm());
    } else {
      result.released = std::max(result.released, sample.truth.acceleration.head<3>().norm());
      result.jump = std::max(result.jump, std::abs(dq - last_dq) * rate_Hz);
    }
    last_dq = dq;
  });
  result.hand = run.summary().truth().max_hand_distance();
  result.clamped = run.summary().truth().clamped_cycles();
  result.fault = run.summary().fault().code;
  return result;
}

constexpr double kErrorClamp = 7e-3;  // rad, control.error_max_rad of the device

TEST(StuckJoint, NeitherReferenceNorTwinRunAwayFromPerfectDrives) {
  config::Scenario scenario = with_ideal_device(raising());
  scenario.device.estimation.wrench.has_imu = false;  // it would see that the handle stops at once
  ASSERT_EQ(scenario.device.control.error_max, kErrorClamp);
  const StuckJoint stuck = stuck_joint(scenario);
  EXPECT_EQ(stuck.fault, FaultCode::kNone);
  EXPECT_EQ(stuck.moved, 0.0);
  EXPECT_GT(stuck.pull, 20.0);
  EXPECT_GT(stuck.clamped, 100u);
  EXPECT_LE(stuck.stuck_error, kErrorClamp + 1e-4);
  EXPECT_GT(stuck.stuck_error, 0.5 * kErrorClamp);  // the hand pulls towards it
  EXPECT_LT(stuck.hand, 5e-3);                      // 7 mrad on 0.42 m, and what others deviate
}

// [C] 6: bounds of 3 and 10 mrad gave 46 to 54 N, and 16 to 28 m/s^2 on release
TEST(StuckJoint, ElasticJointsComeBackWithoutAKick) {
  config::Scenario scenario = raising();
  // which would stop it at once
  scenario.device.monitor.motor_tolerance = scenario.device.monitor.unexplained_tolerance =
      kInfinity;
  const StuckJoint stuck = stuck_joint(scenario);
  EXPECT_EQ(stuck.fault, FaultCode::kNone);
  EXPECT_LT(stuck.moved, 0.02);
  EXPECT_GT(stuck.pull, 20.0);
  EXPECT_GT(stuck.clamped, 50u);
  EXPECT_LE(stuck.stuck_error, kErrorClamp + 1e-3);  // estimation and one period of motion
  EXPECT_LT(stuck.hand, 6e-3);
  EXPECT_LT(stuck.released, 28.0);
  EXPECT_LE(stuck.jump, 20.0 + 1e-6);  // rating of m4
}

}  // namespace
}  // namespace hg
