/// What `run` asks of a remote device that is no simulation: a start test that counts, and a
/// posture that is the one in which the last run has left it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "apps/hapticgiant/device_memory.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/prepared_run.h"
#include "apps/hapticgiant/remote_setup.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/run_setup.h"
#include "hg/assembly/assembly.h"
#include "hg/core/error.h"
#include "hg/remote/device_server.h"
#include "hg/start_test/memory.h"

namespace hg {
namespace {

// a simulation that says it were none, whose gantry may be homed wrongly
class Homed final : public device::Device {
 public:
  Homed(device::SimulatedDevice device, double offset)
      : device_(std::move(device)), offset_(offset) {}
  void read(SensorFrame& sensors) noexcept override {
    device_.read(sensors);
    sensors.q_p[0] += offset_;
  }
  void write(const CommandFrame& command) noexcept override { device_.write(command); }

 private:
  device::SimulatedDevice device_;
  double offset_;
};

class Machine {
 public:
  explicit Machine(const config::Scenario& scenario, bool is_simulated = false)
      : world_(assembly::make_simulated_device(scenario)),
        server_({"127.0.0.1", "0"}, {.actual = apps::describe(scenario, true),
                                     .server = "test",
                                     .is_simulated = is_simulated,
                                     .lock_step_timeout_s = 60.0}),
        thread_([this] {
          while (server_.wait_for_client(stop_)) {
            Homed device(world_, homing_error.load());
            server_.serve(device, stop_);
          }
        }) {}
  ~Machine() {
    stop_.store(true);
    thread_.join();
  }
  std::string address() const { return server_.address(); }

  std::atomic<double> homing_error{0.0};  ///< of the first axis, from the next session on, m

 private:
  std::atomic<bool> stop_{false};
  device::SimulatedDevice world_;
  remote::DeviceServer server_;
  std::thread thread_;
};

class MachineTest : public ::testing::Test {
 protected:
  MachineTest() {
    folder_ = std::filesystem::temp_directory_path() / ("machine_test_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    arguments_.world.scenario = "free_space";
    arguments_.duration_s = 1.0;
    arguments_.is_fast = true;
    arguments_.has_viewer = arguments_.has_recording = false;
    arguments_.recordings = folder_.string();
  }
  ~MachineTest() override { std::filesystem::remove_all(folder_); }

  void keep_result(const config::Device& device, bool has_passed = true) {
    start_test::Result result = {.device = device.name,
                                 .version = "test",
                                 .files_sha256 = apps::sha256_of(device),
                                 .ended = std::time(nullptr),
                                 .has_passed = has_passed};
    apps::write_output(apps::start_test_file(folder_.string(), device), to_json(result));
  }
  std::string refusal() const {
    try {
      const apps::PreparedRun run(arguments_);
      return {};
    } catch (const SetupError& error) {
      return error.what();
    }
  }

  std::filesystem::path folder_;
  apps::RunArguments arguments_;
};

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' without '" << part << "'";
}

TEST_F(MachineTest, RunsOnlyWithAStartTestThatCounts) {
  const config::Scenario scenario = apps::make_scenario(arguments_.world);
  const Machine machine(scenario);
  arguments_.device_address = machine.address();
  expect_part(refusal(), "no start test of HapticGiant that counts: there is none");
  expect_part(refusal(), "--without-start-test");
  keep_result(scenario.device, false);
  expect_part(refusal(), "it did not come to its end");
  config::Device other = scenario.device;
  other.sources.front().content += "# changed";
  keep_result(other);
  expect_part(refusal(), "the files of the device have changed since");
  keep_result(scenario.device);
  EXPECT_EQ(refusal(), "");
}

TEST_F(MachineTest, GoesWithoutAStartTestWhereThatIsSaid) {
  const Machine machine(apps::make_scenario(arguments_.world));
  arguments_.device_address = machine.address();
  arguments_.without_start_test = true;
  const apps::PreparedRun run(arguments_);
  EXPECT_EQ(run.start_test, "BRAKES AND STOP INPUTS ARE NOT TESTED: there is none");
}

TEST_F(MachineTest, ASimulationIsAskedForNothing) {
  const Machine machine(apps::make_scenario(arguments_.world), true);
  arguments_.device_address = machine.address();
  const apps::PreparedRun run(arguments_);
  EXPECT_FALSE(run.is_machine);
  EXPECT_EQ(run.start_test, "");
}

TEST_F(MachineTest, AGantryThatWasHomedThirtyCentimetresOffIsRefusedByName) {
  Machine machine(apps::make_scenario(arguments_.world));
  arguments_.device_address = machine.address();
  arguments_.without_start_test = true;
  EXPECT_EQ(apps::run(arguments_), 1);  // too short for its events
  ASSERT_TRUE(std::filesystem::exists(folder_ / "posture_HapticGiant.json"));
  EXPECT_EQ(refusal(), "");

  machine.homing_error.store(0.3);
  const std::string why = refusal();
  expect_part(why, "HapticGiant stands elsewhere than the last run has left it:\n  ppu1: ");
  expect_part(why, "--posture-confirmed ppu1");
  EXPECT_EQ(why.find("ppu2: "), std::string::npos) << why;
  arguments_.confirmed_joints = {"ppu2"};
  expect_part(refusal(), "ppu1: ");
  arguments_.confirmed_joints = {"ppu1"};
  EXPECT_EQ(refusal(), "");
  arguments_.confirmed_joints = {"nobody"};
  expect_part(refusal(), "HapticGiant has no joint 'nobody'");

  arguments_.confirmed_joints.clear();
  std::ofstream(folder_ / "posture_HapticGiant.json") << "{";
  expect_part(refusal(), "expected the posture that a run has kept");
}

}  // namespace
}  // namespace hg
