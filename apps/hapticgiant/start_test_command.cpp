#include "apps/hapticgiant/start_test_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <ctime>
#include <memory>
#include <utility>

#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/option_checks.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/version.h"
#include "hg/commissioning/start_test/machine_memory.h"
#include "hg/commissioning/start_test/memory.h"
#include "hg/commissioning/start_test/procedure.h"
#include "hg/commissioning/start_test/simulated_operator.h"
#include "hg/controller/cycle.h"
#include "hg/core/error.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/runtime/control_thread.h"
#include "hg/runtime/requests.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/remote/remote_setup.h"

namespace hg::apps {
namespace {

using start_test::Observation;
using start_test::Wish;

constexpr std::uint64_t kResetEdge = 50;  // cycles between a request and the pause before the next

/// The control cycle on the device, and its operator: a person at the terminal, or a simulated one.
class DeviceStation final : public start_test::Station {
 public:
  DeviceStation(const config::Scenario& scenario, device::Device& device, bool is_simulated,
                const std::atomic<bool>& interrupted)
      : cycle_(scenario::make_cycle(scenario)),
        device_(device),
        model_(scenario.device.model),
        chain_(scenario.device.model.chain),
        is_simulated_(is_simulated),
        interrupted_(interrupted) {}

  Observation live(Wish wish) override {
    device_.read(sample_.sensors);
    sample_.operator_input.request = request(wish);
    cycle_.step(sample_.sensors, sample_.operator_input, sample_.command, sample_.record);
    const Observation seen = observe(wish);
    if (is_simulated_) {
      operator_.operate(sample_.sensors.time_s, chain_.pose(model_.handle), sample_.command);
    }
    const bool has_gone = is_gone(sample_.sensors.driver_fault);
    if (interrupted_.load() || has_gone) leave();
    device_.write(sample_.command);
    if (has_gone) {
      end_ = sample_.sensors.driver_fault;
      throw start_test::Ended{std::string(to_string(end_))};
    }
    if (interrupted_.load()) throw start_test::Ended{"interrupted"};
    return seen;
  }

  void ask(start_test::Act act, const std::string& words) override {
    print_out(fmt::format("{:8.1f} s  -> {}\n", sample_.sensors.time_s, words));
    operator_.ask(act);
  }
  void report(const std::string& words) override {
    print_out(fmt::format("{:8.1f} s  {}\n", sample_.sensors.time_s, words));
  }

  /// Switches the drives off.
  void release() {
    leave();
    device_.write(sample_.command);
  }
  /// Fault that ended the connection; kNone = the device is still connected.
  FaultCode end() const { return end_; }

 private:
  static bool is_gone(FaultCode code) {
    return code == FaultCode::kDeviceSilent || code == FaultCode::kDeviceGone ||
           code == FaultCode::kCommandsLost;
  }

  void leave() {
    sample_.command.enable = false;
    sample_.command.dq_m.setZero();
    sample_.command.ddq_m.setZero();
    sample_.command.tau_m.setZero();
    sample_.command.dq_p.setZero();
  }

  // By what the last cycle said; requests act on their edge. Nothing resets what was armed.
  ModeRequest request(Wish wish) const {
    const CycleRecord& record = sample_.record;
    const bool is_pause = record.cycle / kResetEdge % 2 == 0;
    if (wish == Wish::kStay) return ModeRequest::kNone;
    if (record.mode == Mode::kFault) {
      return wish != Wish::kTare || is_pause ? ModeRequest::kNone : ModeRequest::kReset;
    }
    if (record.mode == Mode::kReady && wish != Wish::kOff) {
      const ModeRequest next =
          runtime::next_request(record, cycle_.is_held(sample_.sensors), false);
      if (next == ModeRequest::kArm && (wish != Wish::kArm || is_pause)) return ModeRequest::kNone;
      return next;
    }
    return wish != Wish::kArm && record.mode == Mode::kArmed ? ModeRequest::kStop
                                                             : ModeRequest::kNone;
  }

  Observation observe(Wish wish) {
    const SensorFrame& sensors = sample_.sensors;
    const CycleRecord& record = sample_.record;
    const RobotState& robot = record.robot;
    Observation seen = {.time_s = sensors.time_s,
                        .safety = sensors.safety,
                        .dead_man = sensors.dead_man,
                        .load_m = VectorM::Zero(model_.n_m),
                        .load_p = VectorP::Zero(model_.n_p),
                        .is_powered = sample_.command.enable,
                        .mode = record.mode,
                        .fault = record.fault.code,
                        .refusal = record.refusal};
    if (wish == Wish::kArm && !record.is_tared) seen.refusal = Refusal::kNotTared;
    if (robot.q_m.size() != model_.n_m) return seen;  // the sample was no good
    const bool has_motor_side = robot.theta_m.size() == model_.n_m;
    if (had_motor_side_ && !has_motor_side) return seen;  // nor is this one: another side
    had_motor_side_ = has_motor_side;
    seen.q_m = has_motor_side ? robot.theta_m : robot.q_m;
    seen.q_p = sensors.q_p;
    const Eigen::VectorXd q = stacked(sensors.q_p, robot.q_m);
    const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(model_.n_p + model_.n_m);
    chain_.update(q, at_rest);
    const Eigen::VectorXd user = chain_.jacobian(model_.handle).transpose() * robot.w_H;
    const Eigen::VectorXd load = chain_.gravity() - user;
    seen.load_p = load.head(model_.n_p);
    seen.load_m = robot.tau_m.size() == model_.n_m ? robot.tau_m : VectorM(load.tail(model_.n_m));
    return seen;
  }

  controller::Cycle cycle_;
  device::Device& device_;
  const DeviceModel& model_;
  model::ChainData chain_;
  const bool is_simulated_;
  const std::atomic<bool>& interrupted_;
  start_test::SimulatedOperator operator_;
  Sample sample_;
  bool had_motor_side_ = false;
  FaultCode end_ = FaultCode::kNone;
};

// A brake that holds less than twice the friction of its joint proves nothing.
start_test::Setup setup_of(const config::Device& device, bool is_simulated) {
  constexpr double kOverFriction = 2.0;
  constexpr double kTorque = 1.0, kForce = 10.0;  // where friction is unknown
  constexpr double kGantryTorque = 5.0, kGantryForce = 20.0;
  start_test::Setup setup = {.config = device.start_test, .is_simulated = is_simulated};
  const std::vector<model::Joint>& joints = device.model.chain.joints();
  const std::vector<ActuatorModel>& actuators = device.model.actuators;
  for (int i = 0; i < device.model.n_p + device.model.n_m; ++i) {
    const model::Joint& joint = joints[static_cast<std::size_t>(i)];
    const bool is_slide = joint.type == model::JointType::kPrismatic;
    const bool is_gantry = i < device.model.n_p;
    double least = is_slide ? kForce : kTorque;
    if (is_gantry) least = is_slide ? kGantryForce : kGantryTorque;
    const auto motor = static_cast<std::size_t>(i - device.model.n_p);
    if (!is_gantry && motor < actuators.size()) {
      const ActuatorModel& actuator = actuators[motor];
      least = std::max(least, kOverFriction * actuator.stiction * actuator.coulomb_friction);
    }
    (is_gantry ? setup.gantry : setup.manipulator).push_back({joint.name, is_slide, least});
  }
  return setup;
}

}  // namespace

int start_test(const StartTestArguments& arguments) {
  RunArguments run;
  run.world = arguments.world;
  run.device_address = arguments.device_address;
  run.recordings = arguments.recordings;
  const config::Scenario scenario = make_scenario(run);
  runtime::check({.priority = arguments.priority});
  make_folder(arguments.recordings);

  std::unique_ptr<device::Device> device;
  udp::RemoteDevice* remote = nullptr;
  if (arguments.device_address.empty()) {
    device = scenario::make_simulated_device(scenario);
  } else {
    auto connected = scenario::connect_device(
        arguments.device_address, scenario::key_of(arguments.key_file), scenario,
        std::string("hapticgiant run ") + kVersion, arguments.is_fast);
    remote = connected.get();
    device = std::move(connected);
  }
  const bool is_simulated = remote == nullptr || remote->welcome().is_simulated;
  const std::string file = start_test::start_test_file(
      arguments.recordings, scenario.device, is_simulated ? "" : arguments.device_address);
  check_writable(file);

  const auto keep = [&](const std::vector<start_test::Item>& items) {
    const start_test::Result result = {.device = scenario.device.name,
                                       .address = arguments.device_address,
                                       .version = kVersion,
                                       .files_sha256 = start_test::sha256_of(scenario.device),
                                       .ended = std::time(nullptr),
                                       .is_simulated = is_simulated,
                                       .has_passed = start_test::has_passed(items),
                                       .items = items};
    write_output(file, to_json(result));
  };
  keep({});  // whatever ends this program: an older result counts no more

  const std::atomic<bool>& interrupted = watch_interruption();
  DeviceStation station(scenario, *device, is_simulated, interrupted);
  const BackgroundOutput output(interrupted);
  print_out(fmt::format("HapticGiant {}  start test of {}{}\n", kVersion, scenario.device.name,
                        is_simulated ? ", simulated, with a simulated operator" : ""));
  print_out("stop        Ctrl-C\n");
  if (remote != nullptr && !arguments.is_fast) {
    runtime::become_real_time({.priority = arguments.priority});
  }
  const std::vector<start_test::Item> items =
      start_test::run(setup_of(scenario.device, is_simulated), station);
  station.release();
  if (remote != nullptr) remote->close(station.end());

  const bool has_passed = start_test::has_passed(items);
  keep(items);
  const auto count = [&](start_test::Outcome outcome) {
    return std::ranges::count(items, outcome, &start_test::Item::outcome);
  };
  print_out(fmt::format("\n  start test   {}: {} passed, {} failed, {} not tested\n",
                        has_passed ? "PASSED" : "FAILED", count(start_test::Outcome::kPassed),
                        count(start_test::Outcome::kFailed),
                        count(start_test::Outcome::kUntested)));
  print_out(fmt::format("  kept in      {}{}\n", file,
                        is_simulated ? " (of a simulation: counts for no machine)" : ""));
  if (station.end() != FaultCode::kNone) return 3;
  return has_passed ? 0 : 1;
}

void add_start_test(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<StartTestArguments>();
  CLI::App* command = app.add_subcommand("start-test",
                                         "Brakes and stop inputs, step by step, before the first "
                                         "run of a day (docs/reference/start_test.md).");
  command->footer(
      "Examples:\n"
      "  hapticgiant start-test                   the simulated device, with a simulated operator\n"
      "  hapticgiant start-test --device my_arm_device.yaml --device-address 192.168.1.20:4810");
  add_scenario_options(*command, arguments->world);
  command->add_option("--device-address", arguments->device_address,
                      "HOST:PORT of a remote device instead of a simulated one");
  command
      ->add_option("--key-file", arguments->key_file,
                   "secret that the remote device has, too (docs/reference/device_protocol.md)")
      ->needs("--device-address");
  command
      ->add_flag("--fast", arguments->is_fast, "lock-step with a remote device that is simulated")
      ->needs("--device-address");
  command
      ->add_option("--priority", arguments->priority,
                   "SCHED_FIFO priority with a remote device, 1..99; 0: an ordinary thread")
      ->check(number_that("from 0 to 99", [](double v) { return v >= 0.0 && v <= 99.0; }))
      ->capture_default_str();
  command->add_option("--recordings", arguments->recordings, "folder that keeps the result")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = start_test(*arguments); });
}

}  // namespace hg::apps
