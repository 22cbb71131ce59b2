/// What `run` requires of a remote device that is no simulation: a start test that counts, and a
/// posture that is the one in which the last run has left it.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "apps/hapticgiant/commission_command.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/start_test_command.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/core/test/message_of.h"
#include "hg/core/whole_file.h"
#include "hg/device/udp/device_server.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/options.h"
#include "hg/scenario/remote/ethercat_setup.h"
#include "hg/scenario/remote/remote_setup.h"
#include "hg/scenario/run/prepared_run.h"
#include "hg/simulator/simulated_device.h"
#include "hg/start_test/machine_memory.h"
#include "hg/start_test/memory.h"

namespace hg {
namespace {

// a simulation that says it were none, whose gantry may be homed wrongly, and the brake of whose m5
// may not hold
class Homed final : public device::Device {
 public:
  Homed(simulator::Simulation device, double offset, double falling)
      : device_(std::move(device)), offset_(offset), falling_(falling) {}
  void read(SensorFrame& sensors) noexcept override {
    device_.read(sensors);
    sensors.q_p[0] += offset_;
    if (was_on_ && !is_on_) fallen_ += 1e-3 * falling_;
    sensors.q_m[4] += fallen_;
  }
  void write(const CommandFrame& command) noexcept override {
    is_on_ = command.enable;
    was_on_ = was_on_ || is_on_;
    device_.write(command);
  }

 private:
  simulator::SimulatedDevice device_;
  double offset_, falling_, fallen_ = 0.0;
  bool is_on_ = false, was_on_ = false;
};

class Machine {
 public:
  explicit Machine(const config::Scenario& scenario, bool is_simulated = false,
                   bool is_lock_step = true)
      : world_(scenario::make_simulation(scenario)),
        server_({"127.0.0.1", "0"}, {.actual = scenario::describe(scenario, is_lock_step),
                                     .server = "test",
                                     .is_simulated = is_simulated,
                                     .lock_step_timeout_s = 60.0}),
        thread_([this] {
          while (server_.wait_for_client(stop_)) {
            Homed device(world_, homing_error.load(), falling.load());
            server_.serve(device, stop_);
          }
        }) {}
  ~Machine() {
    stop_.store(true);
    thread_.join();
  }
  std::string address() const { return server_.address(); }

  std::atomic<double> homing_error{0.0};  ///< of the first axis, from the next session on, m
  std::atomic<double> falling{0.0};       ///< speed of m5 once the power has gone, rad/s; the same

 private:
  std::atomic<bool> stop_{false};
  simulator::Simulation world_;
  udp::DeviceServer server_;
  std::thread thread_;
};

class MachineTest : public ::testing::Test {
 protected:
  MachineTest() {
    folder_ = std::filesystem::temp_directory_path() / ("machine_test_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    plan_.world.scenario = "free_space";
    plan_.timing.duration_s = 1.0;
    plan_.timing.is_fast = true;
    plan_.page.is_served = plan_.records.has_recording = false;
    plan_.records.folder = folder_.string();
  }
  ~MachineTest() override { std::filesystem::remove_all(folder_); }

  void keep_result(const config::DeviceConfig& device, bool has_passed = true) {
    start_test::StartTestResult result = {.device = device.name,
                                          .address = plan_.machine.address,
                                          .version = "test",
                                          .files_sha256 = start_test::sha256_of(device),
                                          .ended = std::time(nullptr),
                                          .has_passed = has_passed};
    write_whole_file(start_test::start_test_file(folder_.string(), device, plan_.machine.address),
                     to_json(result));
  }
  std::filesystem::path posture_file() const {
    return start_test::file_of(folder_.string(), "posture", "HapticGiant", plan_.machine.address);
  }
  scenario::PreparedRun prepare() const {
    return {plan_.world, plan_.machine, plan_.timing, plan_.records};
  }
  std::string refusal() const {
    try {
      const scenario::PreparedRun run = prepare();
      return {};
    } catch (const SetupError& error) {
      return error.what();
    }
  }

  std::filesystem::path folder_;
  scenario::RunPlan plan_;
};

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' without '" << part << "'";
}

TEST_F(MachineTest, RunsOnlyWithAStartTestThatCounts) {
  const config::Scenario scenario = scenario::load(plan_.world);
  const Machine machine(scenario);
  plan_.machine.address = machine.address();
  expect_part(refusal(), "no start test of HapticGiant that counts: there is none");
  expect_part(refusal(), "--without-start-test");
  keep_result(scenario.device, false);
  expect_part(refusal(), "it did not finish");
  config::DeviceConfig other = scenario.device;
  other.sources.front().content += "# changed";
  keep_result(other);
  expect_part(refusal(), "the files of the device have changed since");
  keep_result(scenario.device);
  EXPECT_EQ(refusal(), "");
}

TEST_F(MachineTest, RunsWithoutAStartTestWhereTheFileAllowsIt) {
  const Machine machine(scenario::load(plan_.world));
  plan_.machine.address = machine.address();
  plan_.machine.without_start_test = true;
  const scenario::PreparedRun run = prepare();
  EXPECT_EQ(run.connection->start_test, "BRAKES AND STOP INPUTS ARE NOT TESTED: there is none");
}

TEST_F(MachineTest, AMachineTakesNoInjectedFaults) {
  config::Scenario scenario = scenario::load(plan_.world);
  const Machine machine(scenario), demo(scenario, true);
  for (const char* const name : {"motor_dead", "brake_weak", "cycles_late", "solver_hurried"}) {
    scenario.faults = {{.kind = faults::find_kind(name), .magnitude = 1.0}};
    const auto connect = [&](const Machine& to) {
      return message_of(
          [&] { scenario::connect_device(to.address(), {}, scenario, "test", true, 60.0); });
    };
    EXPECT_EQ(connect(machine), "faults: the device at " + machine.address() +
                                    " is a machine, only a simulated one takes injected faults, "
                                    "got " +
                                    name);
    EXPECT_EQ(connect(demo), "no error");
  }
}

TEST_F(MachineTest, ASimulationNeedsNoStartTest) {
  const Machine machine(scenario::load(plan_.world), true);
  plan_.machine.address = machine.address();
  const scenario::PreparedRun run = prepare();
  EXPECT_EQ(run.machine(), nullptr);
  EXPECT_EQ(run.connection->start_test, "");
}

TEST_F(MachineTest, AGantryThatWasHomedThirtyCentimetresOffIsRefusedByName) {
  Machine machine(scenario::load(plan_.world));
  plan_.machine.address = machine.address();
  plan_.machine.without_start_test = true;
  EXPECT_EQ(apps::run({.plan = plan_}), 1);  // too short for its events
  ASSERT_TRUE(std::filesystem::exists(posture_file()));
  EXPECT_EQ(refusal(), "");

  machine.homing_error.store(0.3);
  const std::string why = refusal();
  expect_part(why, "HapticGiant stands elsewhere than the last run has left it:\n  ppu1: ");
  expect_part(why, "--posture-confirmed ppu1");
  EXPECT_EQ(why.find("ppu2: "), std::string::npos) << why;
  plan_.machine.confirmed_joints = {"ppu2"};
  expect_part(refusal(), "ppu1: ");
  plan_.machine.confirmed_joints = {"ppu1"};
  EXPECT_EQ(refusal(), "");
  plan_.machine.confirmed_joints = {"missing"};
  expect_part(refusal(), "HapticGiant has no joint 'missing'");

  plan_.machine.confirmed_joints.clear();
  std::ofstream(posture_file()) << "{";
  expect_part(refusal(), "expected the posture that a run has kept");
}

TEST_F(MachineTest, AfterABrakeThatDidNotHoldTheStartTestCountsNoMore) {
  const config::Scenario scenario = scenario::load(plan_.world);
  Machine machine(scenario);
  plan_.machine.address = machine.address();
  keep_result(scenario.device);
  EXPECT_EQ(apps::run({.plan = plan_}), 1);
  EXPECT_EQ(refusal(), "") << "brakes that hold";
  machine.falling.store(0.3);
  testing::internal::CaptureStdout();
  EXPECT_EQ(apps::run({.plan = plan_}), 1);
  const std::string said = testing::internal::GetCapturedStdout();
  expect_part(said, "m5 MOVES WITH ITS BRAKE CLOSED");
  expect_part(said, "start test   counts no more");
  expect_part(refusal(), "no start test of HapticGiant that counts: there is none");
}

TEST_F(MachineTest, AFileThatCannotBeReadIsNotTakenForNone) {
  const config::Scenario scenario = scenario::load(plan_.world);
  const Machine machine(scenario);
  plan_.machine.address = machine.address();
  const std::filesystem::path result =
      start_test::start_test_file(folder_.string(), scenario.device, machine.address());
  ASSERT_EQ(mkfifo(result.c_str(), 0600), 0);  // without a writer
  expect_part(refusal(), "expected a file, got a named pipe");
  plan_.machine.without_start_test = true;
  EXPECT_EQ(refusal(), "");
  ASSERT_EQ(mkfifo(posture_file().c_str(), 0600), 0);
  expect_part(refusal(), "expected a file, got a named pipe");
  std::filesystem::remove(posture_file());
  std::ofstream(posture_file()) << std::string(1'100'000, ' ');
  expect_part(refusal(), "it has more than 1000000 bytes");
  std::filesystem::remove(posture_file());
  std::filesystem::create_directory(posture_file());
  expect_part(refusal(), "expected a file, got a folder");
}

TEST_F(MachineTest, AStartTestOfAnotherMachineOfTheSameNameDoesNotCount) {
  const config::Scenario scenario = scenario::load(plan_.world);
  const Machine machine(scenario), other(scenario);
  plan_.machine.address = other.address();
  keep_result(scenario.device);
  EXPECT_EQ(refusal(), "");
  const std::string kept =
      start_test::start_test_file(folder_.string(), scenario.device, other.address());
  plan_.machine.address = machine.address();
  expect_part(refusal(), "there is none");
  std::filesystem::rename(
      kept, start_test::start_test_file(folder_.string(), scenario.device, machine.address()));
  expect_part(refusal(), "it is of the device at " + other.address());
}

TEST_F(MachineTest, ADemoLeavesTheResultOfAMachine) {
  const config::Scenario scenario = scenario::load(plan_.world);
  Machine machine(scenario), demo(scenario, true);
  plan_.machine.address = machine.address();
  keep_result(scenario.device);
  for (const std::string& address : {std::string(), demo.address()}) {
    apps::MachineOptions arguments;
    arguments.machine.address = address;
    arguments.timing.is_fast = true;
    arguments.folder = folder_.string();
    EXPECT_EQ(apps::start_test(arguments), 0);
    EXPECT_TRUE(std::filesystem::remove(folder_ / "start_test_HapticGiant_simulated.json"));
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
  EXPECT_EQ(refusal(), "");
}

TEST_F(MachineTest, ASimulationIsCommissionedHereAndBehindAWire) {
  const config::Scenario scenario = scenario::load(plan_.world);
  Machine machine(scenario, true);
  for (const std::string& address : {std::string(), machine.address()}) {
    apps::CommissionArguments options;
    options.machine.machine.address = address;
    options.machine.timing.is_fast = true;
    options.machine.folder = folder_.string();
    EXPECT_EQ(apps::commission(options), 0);
    EXPECT_TRUE(std::filesystem::remove(folder_ / "commission_HapticGiant_simulated.json"));
  }
}

// The tests have no terminal.
TEST_F(MachineTest, AMachineIsCommissionedOnlyAtATerminal) {
  const config::Scenario scenario = scenario::load(plan_.world);
  Machine machine(scenario);
  apps::CommissionArguments options;
  options.machine.machine.address = machine.address();
  options.machine.timing.is_fast = true;
  options.machine.folder = folder_.string();
  const int terminal = dup(STDIN_FILENO), none = open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(none, STDIN_FILENO);
  expect_part(message_of([&] { apps::commission(options); }),
              "a machine moves only while a person holds the space bar");
  dup2(terminal, STDIN_FILENO);
  close(none);
  close(terminal);
}

TEST_F(MachineTest, AComputerThatIsNotReadyIsOverruledByNameOnly) {
  const config::Scenario scenario = scenario::load(plan_.world);
  const Machine machine(scenario, false, false);
  plan_.machine.address = machine.address();
  plan_.machine.despite = {"latenes"};
  const std::string words = "no item of the doctor is 'latenes', did you mean 'lateness'?";
  for (const bool is_fast : {false, true}) {  // in lock-step nothing else is asked of the computer
    plan_.timing.is_fast = is_fast;
    expect_part(refusal(), words);
  }
  apps::MachineOptions options;
  options.world = plan_.world;
  options.folder = folder_.string();
  options.machine.despite = plan_.machine.despite;
  expect_part(message_of([&] { apps::start_test(options); }), words);
  expect_part(message_of([&] { apps::commission({.machine = options}); }), words);
}

TEST_F(MachineTest, AnotherFileOfTheBusIsAnotherMachine) {
  const auto hash_with = [&](const std::filesystem::path& file) {
    config::Scenario scenario = scenario::load(plan_.world);
    scenario::ethercat_config("ethercat://nowhere", file, scenario, true);
    return start_test::sha256_of(scenario.device);
  };
  const std::filesystem::path shipped = "models/haptic_giant/machine.yaml";
  const std::string before = hash_with({});
  EXPECT_EQ(hash_with(shipped), before);
  EXPECT_NE(start_test::sha256_of(scenario::load(plan_.world).device), before);
  const std::filesystem::path changed = folder_ / "machine.yaml";
  std::string text = read_file(shipped);
  const std::string scale = "scale: 0.09";
  ASSERT_NE(text.find(scale), std::string::npos);
  write_whole_file(changed, text.replace(text.find(scale), scale.size(), "scale: 0.08"));
  EXPECT_NE(hash_with(changed), before);
}

TEST_F(MachineTest, AServerBusyWithTheSessionBeforeIsTriedAgain) {
  const config::Scenario scenario = scenario::load(plan_.world);
  const Machine machine(scenario);
  plan_.machine.address = machine.address();
  auto before = scenario::connect_device(machine.address(), {}, scenario, "test", true);
  SensorFrame sensors;
  before->read(sensors);  // it has the device
  std::thread goes([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    before.reset();
  });
  EXPECT_NE(scenario::connect_device(machine.address(), {}, scenario, "test", true, 60.0), nullptr);
  goes.join();
}

}  // namespace
}  // namespace hg
