#include "apps/hapticgiant/prepared_run.h"

#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/remote/remote_setup.h"

namespace hg::apps {

start_test::MachineMemory machine_memory(const RunArguments& arguments) {
  return {.folder = arguments.recordings,
          .address = arguments.device_address,
          .without_start_test = arguments.without_start_test,
          .confirmed_joints = arguments.confirmed_joints};
}

PreparedRun::PreparedRun(const RunArguments& a)
    : arguments(a), scenario(make_scenario(a)), cycle(scenario::make_cycle(scenario)) {
  if (arguments.device_address.empty()) {
    device = scenario::make_simulated_device(scenario);
    return;
  }
  const auto connect = [&](double busy_patience_s) {
    return scenario::connect_device(arguments.device_address, scenario::key_of(arguments.key_file),
                                    scenario, std::string("hapticgiant run ") + kVersion,
                                    arguments.is_fast, busy_patience_s);
  };
  auto connected = connect(0.0);
  is_machine = !connected->welcome().is_simulated;
  if (is_machine) {
    const start_test::MachineMemory memory = machine_memory(arguments);
    start_test = start_test::check_start_test(memory, scenario.device);
    posture = start_test::check_posture(memory, scenario.device, *connected);
    // the server may not know yet that the session for the posture is over
    constexpr double kFarewell = 0.5;  // s
    connected = connect(kFarewell);
  }
  remote = connected.get();
  device = std::move(connected);
}

page::ShownRun PreparedRun::shown() const {
  return {.scenario = &scenario,
          .options = &arguments.world,
          .refusal = remote == nullptr
                         ? ""
                         : "the device at " + arguments.device_address + " keeps its own time"};
}

}  // namespace hg::apps
