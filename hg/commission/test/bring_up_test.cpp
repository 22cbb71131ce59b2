#include "hg/commission/bring_up.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/commission/simulated_crew.h"
#include "hg/commission/test/miswired_device.h"
#include "hg/scenario/assembly.h"

namespace hg::commission {
namespace {

// A simulated machine whose time passes also while it gets no command.
class Unwaiting final : public device::Device {
 public:
  explicit Unwaiting(device::Device& machine) : machine_(machine) {}

  void read(SensorFrame& sensors) noexcept override {
    if (!std::exchange(is_answered_, false) && last_.enable) machine_.write(last_);
    machine_.read(sensors);
  }
  void write(const CommandFrame& command) noexcept override {
    last_ = command;
    is_answered_ = true;
    machine_.write(command);
  }
  const Truth* truth() const noexcept override { return machine_.truth(); }

 private:
  device::Device& machine_;
  CommandFrame last_;
  bool is_answered_ = true;
};

// A first session with a machine that is connected so.
struct Session {
  std::vector<Item> items;
  double astray = 0.0;  // largest true motion of a joint of the arm from where it stood, rad

  Session(const config::Scenario& scenario, const Miswiring& mistake, const Options& options = {}) {
    const auto machine = scenario::make_simulated_device(scenario);
    Unwaiting unwaiting(*machine);
    MiswiredDevice device(unwaiting, mistake);
    struct Watching final : SimulatedCrew {
      const device::Device& machine;
      VectorM start;
      double astray = 0.0;
      Watching(const device::Device& m, const std::atomic<bool>& interrupted)
          : SimulatedCrew(interrupted), machine(m) {}
      void act(const Pose& T_B_H, CommandFrame& command) override {
        SimulatedCrew::act(T_B_H, command);
        const VectorM& q = machine.truth()->q_m;
        if (start.size() == 0) start = q;
        astray = std::max(astray, (q - start).cwiseAbs().maxCoeff());
      }
    };
    const std::atomic<bool> interrupted{false};
    Watching crew(*machine, interrupted);
    Rig rig(scenario.device, device, crew);
    items = run(rig, options);
    astray = crew.astray;
  }

  bool has_passed() const { return start_test::has_passed(items); }
  // The first failure, as "STEP: words"; empty: none.
  std::string failure() const {
    const auto failed = std::ranges::find(items, Outcome::kFailed, &Item::outcome);
    return failed == items.end() ? "" : failed->name + ": " + failed->found;
  }
};

config::Scenario giant() { return config::load_scenario("models/scenarios/door.yaml"); }
config::Scenario ur5e() { return config::load_scenario("models/arms/ur5e/open_cupboard.yaml"); }

TEST(BringUp, AMachineThatIsConnectedRightlyPasses) {
  const auto fr3 = config::load_scenario("models/arms/fr3/open_drawer.yaml");
  for (const config::Scenario& scenario : {giant(), ur5e(), fr3}) {
    const Session session(scenario, {});
    EXPECT_TRUE(session.has_passed()) << session.failure();
    EXPECT_EQ(std::ranges::count(session.items, Outcome::kUntested, &Item::outcome), 0);
    EXPECT_LT(session.astray, 0.1);
  }
}

TEST(BringUp, AWatchdogThatSwitchesTheDrivesOffIsNoEndOfTheSession) {
  const Session session(giant(), {}, {.falls_silent = true});
  EXPECT_TRUE(session.has_passed()) << session.failure();
  const auto silence = std::ranges::find(session.items, "silence", &Item::name);
  ASSERT_NE(silence, session.items.end());
  EXPECT_EQ(silence->found,
            "it switched the drives off: no new commands reached the device: lost or held up");
}

// What is wrong is found, with one of these names, and before that nothing moves by more than a
// stroke of a joint that moves twice as far as its encoder says.
void expect_found(const config::Scenario& scenario, const Miswiring& mistake,
                  const std::vector<std::string>& names) {
  const Session session(scenario, mistake);
  const std::string failure = session.failure();
  EXPECT_TRUE(std::ranges::any_of(
      names, [&](const std::string& name) { return failure.find(name) != std::string::npos; }))
      << names[0] << "\n    " << failure;
  EXPECT_LT(session.astray, 0.17) << names[0] << "\n    " << failure;
}

// Joints of an arm, root to tip.
std::vector<std::string> joints_of(const config::Scenario& scenario) {
  std::vector<std::string> names;
  for (int i = 0; i < scenario.device.model.n_m; ++i) {
    names.push_back(scenario.device.model.manipulator_joint(i));
  }
  return names;
}

TEST(BringUp, WrongSignsAreFound) {
  for (const config::Scenario& scenario : {giant(), ur5e()}) {
    const std::vector<std::string> names = joints_of(scenario);
    for (int i = 0; i < 6; ++i) {
      SCOPED_TRACE(names[i]);
      expect_found(scenario, {.joint = i, .command = -1.0}, {names[i]});
      expect_found(scenario, {.joint = i, .encoder = -1.0, .motor = -1.0}, {names[i]});
      expect_found(scenario, {.joint = i, .speed = -1.0}, {names[i]});
      // of command and encoders together
      expect_found(scenario,
                   {.joint = i, .encoder = -1.0, .motor = -1.0, .torque = -1.0, .command = -1.0},
                   {names[i]});
    }
  }
}

TEST(BringUp, SwappedJointsAreFound) {
  for (const config::Scenario& scenario : {giant(), ur5e()}) {
    const std::vector<std::string> names = joints_of(scenario);
    for (int i = 0; i < 5; ++i) {
      SCOPED_TRACE(names[i]);
      for (const bool swaps_sensors : {false, true}) {
        expect_found(scenario,
                     {.joint = i,
                      .other = i + 1,
                      .swaps_sensors = swaps_sensors,
                      .swaps_commands = !swaps_sensors},
                     {names[i], names[i + 1]});
      }
      // m1 and m2 of the giant are parallel: what is swapped in all of them turns the same way
      if (names[i] == "m1") continue;
      expect_found(scenario, {.joint = i, .other = i + 1}, {names[i + 1]});
    }
  }
}

TEST(BringUp, WrongGearRatiosAreFound) {
  for (const config::Scenario& scenario : {giant(), ur5e()}) {
    const std::vector<std::string> names = joints_of(scenario);
    for (int i = 0; i < 6; ++i) {
      SCOPED_TRACE(names[i]);
      expect_found(scenario, {.joint = i, .encoder = 0.5, .motor = 0.5, .command = 2.0},
                   {names[i]});
      expect_found(scenario, {.joint = i, .speed = 0.5}, {names[i]});
    }
  }
}

TEST(BringUp, WrongZeroPositionsAreFoundOrSaidNotToBe) {
  const std::vector<std::string> names = joints_of(giant());
  for (int i = 0; i < 3; ++i) {  // about vertical axes
    const Session session(giant(), {.joint = i, .zero = 0.2});
    EXPECT_TRUE(session.has_passed()) << session.failure();
    EXPECT_NE(session.items.back().found.find(names[i]), std::string::npos)
        << session.items.back().found;
  }
  for (int i = 3; i < 6; ++i) {
    SCOPED_TRACE(names[i]);
    expect_found(giant(), {.joint = i, .zero = 0.2}, {names[i]});
  }
}

TEST(BringUp, SamplesThatTheConnectionFilledInAreMissing) {
  for (const std::uint64_t count : {5U, 60U}) {  // of the 2000 of the first step
    std::uint64_t calls = 0;
    const Session session(giant(), {}, {.filled_in = [&] { return count * calls++; }});
    EXPECT_EQ(session.has_passed(), count == 5) << session.failure();
    EXPECT_NE(session.items[0].found.find(std::to_string(count) + " filled in"), std::string::npos)
        << session.items[0].found;
  }
}

TEST(BringUp, WrongSensorsAreFound) {
  expect_found(giant(), {.joint = 1, .motor = -1.0}, {"m2"});
  expect_found(giant(), {.joint = 1, .torque = -1.0}, {"m2 swings while"});
  expect_found(giant(), {.force = -1.0}, {"force/torque sensor"});
  expect_found(ur5e(), {.force = -1.0}, {"force/torque sensor"});
}

}  // namespace
}  // namespace hg::commission
