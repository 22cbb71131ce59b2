#include "apps/hapticgiant/prepared_run.h"

#include <fmt/format.h>

#include <future>
#include <utility>

#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/doctor/gate.h"
#include "hg/runtime/control_thread.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/remote/ethercat_setup.h"
#include "hg/scenario/remote/franka_setup.h"
#include "hg/scenario/remote/remote_setup.h"
#include "hg/scenario/start_posture.h"

namespace hg::apps {

start_test::MachineMemory machine_memory(const RunArguments& arguments) {
  return {.folder = arguments.recordings,
          .address = arguments.device_address,
          .without_start_test = arguments.without_start_test,
          .confirmed_joints = arguments.confirmed_joints};
}

PreparedRun::PreparedRun(const RunArguments& a) : PreparedRun(a, make_scenario(a)) {}

PreparedRun::PreparedRun(const RunArguments& a, config::Scenario loaded)
    : arguments(a),
      scenario(std::move(loaded)),
      cycle(scenario::make_cycle(scenario)),
      fixed_by(a.is_trial() ? "this run is a trial of a study" : "") {
  doctor::check_items(arguments.despite);
  if (arguments.device_address.empty()) {
    device = scenario::make_simulated_device(scenario);
  } else if (scenario::is_franka(arguments.device_address)) {
    connect_franka();
  } else if (scenario::is_ethercat(arguments.device_address)) {
    connect_ethercat();
  } else {
    connect_remote();
  }
}

// In lock-step a late computer does no harm.
void PreparedRun::check_computer() {
  if (arguments.is_fast) return;
  computer = doctor::check_ready(scenario.device.model.rate_Hz,
                                 {.priority = arguments.priority, .cpu = arguments.cpu},
                                 arguments.despite);
}

void PreparedRun::connect_franka() {
  if (arguments.is_fast) throw SetupError("--fast: a Franka keeps its own time, leave it out");
  if (!arguments.key_file.empty()) throw SetupError("--key-file: a Franka's protocol has no key");
  check_computer();
  auto connected = scenario::connect_franka(arguments.device_address, scenario);
  if (arguments.moves_to_start) {
    const VectorM start = scenario::find_start(scenario.device, scenario.twin).q_m;
    std::async(std::launch::async, [&] {
      runtime::become_real_time({.priority = arguments.priority, .cpu = arguments.cpu});
      connected->move_to(start);
    }).get();
  }
  note = "a Franka tests its brakes and stops itself: no start test is required";
  if (!connected->has_checked_signs()) {
    note +=
        "; the weight of the tool does not appear in its estimate: push lightly first, and see "
        "that "
        "the arm yields that way";
  }
  remote = connected.get();
  device = std::move(connected);
}

void PreparedRun::connect_ethercat() {
  if (!arguments.key_file.empty()) throw SetupError("--key-file: a bus has no key");
  const ethercat::EthercatConfig config = scenario::ethercat_config(
      arguments.device_address, arguments.machine, scenario, arguments.is_fast);
  const start_test::MachineMemory memory = machine_memory(arguments);
  if (!config.machine.moves_with_frames) {
    start_test = start_test::check_start_test(memory, scenario.device);
    check_computer();
  }
  auto connected = std::make_unique<ethercat::EthercatDevice>(config);
  remote = connected.get();
  if (config.machine.moves_with_frames) {
    note = "the machine file says that the segment is a simulation: no start test is required";
  } else {
    posture = start_test::check_posture(memory, scenario.device, *connected);
    machine = connected.get();
  }
  device = std::move(connected);
}

void PreparedRun::connect_remote() {
  // the server may not know yet that the session for the posture is over
  constexpr double kFarewell = 0.5;  // s
  const auto connect = [&](double busy_patience_s) {
    return scenario::connect_device(arguments.device_address, scenario::key_of(arguments.key_file),
                                    scenario, fmt::format("hapticgiant run {}", kVersion),
                                    arguments.is_fast, busy_patience_s);
  };
  // nor that the one that has moved the device to the start is
  auto connected = connect(arguments.moves_to_start ? kFarewell : 0.0);
  note = "the device says that it is a simulation: no start test is required";
  if (!connected->welcome().is_simulated) {
    const start_test::MachineMemory memory = machine_memory(arguments);
    start_test = start_test::check_start_test(memory, scenario.device);
    posture = start_test::check_posture(memory, scenario.device, *connected);
    connected->close(FaultCode::kNone);
    check_computer();
    connected = connect(kFarewell);
    machine = connected.get();
  }
  remote = connected.get();
  device = std::move(connected);
}

page::ShownRun PreparedRun::shown() const {
  return {.scenario = &scenario,
          .options = &arguments.world,
          .refusal = remote == nullptr
                         ? ""
                         : "the device at " + arguments.device_address + " keeps its own time",
          .fixed_by = fixed_by};
}

}  // namespace hg::apps
