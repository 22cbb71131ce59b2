#include "apps/hapticgiant/prepared_run.h"

#include "apps/hapticgiant/device_memory.h"
#include "apps/hapticgiant/remote_setup.h"
#include "apps/hapticgiant/run_setup.h"
#include "hg/core/error.h"
#include "hg/scenario/assembly.h"

namespace hg::apps {

PreparedRun::PreparedRun(const RunArguments& a)
    : arguments(a), scenario(make_scenario(a)), cycle(scenario::make_cycle(scenario)) {
  if (arguments.device_address.empty()) {
    device = scenario::make_simulated_device(scenario);
    return;
  }
  const auto connect = [&](double busy_patience_s) {
    return connect_device(arguments.device_address, key_of(arguments.key_file), scenario,
                          arguments.is_fast, busy_patience_s);
  };
  auto connected = connect(0.0);
  is_machine = !connected->welcome().is_simulated;
  if (is_machine) {
    if (!faults::loads_of(scenario.faults).empty()) {
      throw SetupError("faults: cycles_late and solver_hurried are for simulated devices only");
    }
    start_test = check_start_test(arguments, scenario.device);
    posture = check_posture(arguments, scenario.device, *connected);
    // the server may not have heard yet that the session for the posture is over
    constexpr double kFarewell = 0.5;  // s
    connected = connect(kFarewell);
  }
  remote = connected.get();
  device = std::move(connected);
}

}  // namespace hg::apps
