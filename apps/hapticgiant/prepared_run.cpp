#include "apps/hapticgiant/prepared_run.h"

#include "apps/hapticgiant/remote_setup.h"
#include "apps/hapticgiant/run_setup.h"
#include "hg/assembly/assembly.h"

namespace hg::apps {

PreparedRun::PreparedRun(const RunArguments& a)
    : arguments(a), scenario(make_scenario(a)), cycle(assembly::make_cycle(scenario)) {
  if (arguments.device_address.empty()) {
    device = std::make_unique<device::SimulatedDevice>(assembly::make_simulated_device(scenario));
    return;
  }
  auto connected = connect_device(arguments.device_address, key_of(arguments.key_file), scenario,
                                  arguments.is_fast);
  remote = connected.get();
  device = std::move(connected);
}

}  // namespace hg::apps
