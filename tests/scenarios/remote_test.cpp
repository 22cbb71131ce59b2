/// A scenario through UDP in lock-step is the scenario, bit for bit, whatever the network loses.

#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "hg/device/udp/device_server.h"
#include "hg/device/udp/test/bad_link.h"
#include "hg/scenario/remote/remote_setup.h"
#include "tests/scenarios/scenario_run.h"

namespace hg {
namespace {

struct Played {
  std::vector<std::uint64_t> hashes;  // of the states of all cycles
  std::vector<std::string> events;
};

Played played(ScenarioRun& run, double seconds) {
  Played result;
  run.play([&](const Sample& sample) { result.hashes.push_back(sample.record.state_hash); },
           seconds);
  for (const analysis::RunEvent& event : run.summary().events()) {
    result.events.push_back(event.name + " " + std::to_string(event.time_s));
  }
  return result;
}

// Keeps this thread and those that it begins on the processor where it is. Two sides that take
// turns wake each other in half the time there.
class OneProcessor {
 public:
  OneProcessor() {
    sched_getaffinity(0, sizeof(before_), &before_);
    cpu_set_t here;
    CPU_ZERO(&here);
    CPU_SET(sched_getcpu(), &here);
    sched_setaffinity(0, sizeof(here), &here);
  }
  ~OneProcessor() { sched_setaffinity(0, sizeof(before_), &before_); }
  OneProcessor(const OneProcessor&) = delete;
  OneProcessor& operator=(const OneProcessor&) = delete;

 private:
  cpu_set_t before_;
};

// the scenario's world behind a server in a thread of its own
class World {
 public:
  explicit World(const config::Scenario& scenario)
      : device_(scenario::make_simulated_device(scenario)),
        server_({"127.0.0.1", "0"}, {.actual = scenario::describe(scenario, true),
                                     .server = "test",
                                     .lock_step_timeout_s = 60.0}),
        thread_([this] {
          if (server_.wait_for_client(stop_)) server_.serve(*device_, stop_);
        }) {}
  ~World() {
    stop_.store(true);  // the goodbye may be lost on the way
    thread_.join();
  }
  udp::Address address() const { return udp::parse_address("test", server_.address()); }

 private:
  std::atomic<bool> stop_{false};
  std::unique_ptr<device::Device> device_;
  udp::DeviceServer server_;
  std::thread thread_;
};

std::unique_ptr<udp::RemoteDevice> connect(const udp::Address& address,
                                           const config::Scenario& scenario) {
  return std::make_unique<udp::RemoteDevice>(
      address, udp::ClientConfig{.expected = scenario::describe(scenario, true),
                                 .client = "test",
                                 .answer_timeout_s = 60.0,
                                 .first_timeout_s = 60.0,
                                 .lock_step_timeout_s = 60.0});
}

void expect_same(const Played& there, const Played& here) {
  EXPECT_EQ(there.events, here.events);
  ASSERT_EQ(there.hashes.size(), here.hashes.size());
  for (std::size_t i = 0; i < here.hashes.size(); ++i) {
    ASSERT_EQ(there.hashes[i], here.hashes[i]) << "cycle " << i;
  }
}

void expect_same_through_udp(const config::Scenario& scenario) {
  ScenarioRun at_home(scenario);
  const Played here = played(at_home, 1e9);
  const OneProcessor processor;
  World world(scenario);
  ScenarioRun run(scenario, connect(world.address(), scenario));
  const Played there = played(run, 1e9);
  expect_same(there, here);
  EXPECT_FALSE(there.events.empty());
  EXPECT_TRUE(run.missing().empty());
  EXPECT_EQ(run.quality().allocations, 0U);
}

class EveryRemoteScenario : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Shipped, EveryRemoteScenario,
                         ::testing::Values("door", "excavator", "free_space"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EveryRemoteScenario, ThroughUdpIsTheScenarioBitForBit) {
  expect_same_through_udp(shipped(GetParam()));
}

TEST_P(EveryRemoteScenario, AtTwiceTheRateToo) {
  expect_same_through_udp(shipped(GetParam(), 2000.0));
}

TEST(RemoteScenario, ABadNetworkDoesNotChangeTheDoor) {
  constexpr double kSeconds = 3.0;  // every loss takes 20 ms
  const config::Scenario scenario = shipped("door");
  ScenarioRun at_home(scenario);
  const Played here = played(at_home, kSeconds);
  World world(scenario);
  const udp::BadLink link(world.address(),
                          {.loses = 2e-3, .doubles = 0.02, .swaps = 2e-3, .corrupts = 2e-3}, 1);
  ScenarioRun run(scenario, connect(link.address(), scenario));
  expect_same(played(run, kSeconds), here);
}

}  // namespace
}  // namespace hg
