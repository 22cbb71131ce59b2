#include "hg/scenario/run/prepared_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "hg/core/error.h"
#include "hg/doctor/gate.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/remote/remote_machine.h"
#include "hg/scenario/run/version.h"

namespace hg::scenario {
namespace {

// a remote device has its own seed, step, hand and sensors
void refuse_what_is_simulated(const ScenarioOptions& world) {
  std::vector<std::string> given;
  if (world.seed) given.push_back("--seed");
  if (world.step_s) given.push_back("--step");
  if (!world.hand.empty()) given.push_back("--hand");
  if (!world.simulation.empty()) given.push_back("--simulation");
  if (!world.sensors.empty()) given.push_back("--sensors");
  for (const std::string& change : world.changes) {
    if (change.starts_with("simulation.") || change.starts_with("script.")) {
      given.push_back("--set " + change);
    }
  }
  if (given.empty()) return;
  throw SetupError(
      fmt::format("{}: the device of --device-address is simulated elsewhere; give this to "
                  "'hapticgiant simulate' there",
                  fmt::join(given, ", ")));
}

config::Scenario load_for(const ScenarioOptions& world, const MachineAddress& machine,
                          const RunRecords& records) {
  config::Scenario scenario = load_to_run(world, machine);
  scenario.device.rendering.slow_solve = records.slow_solve;
  return scenario;
}

}  // namespace

config::Scenario load_to_run(const ScenarioOptions& world, const MachineAddress& machine) {
  if (!machine.address.empty()) refuse_what_is_simulated(world);
  return load(world);
}

PreparedRun::PreparedRun(const ScenarioOptions& options, const MachineAddress& machine,
                         const RunTiming& timing, const RunRecords& records)
    : PreparedRun(load_for(options, machine, records), options, machine, timing, records) {}

PreparedRun::PreparedRun(config::Scenario loaded, const ScenarioOptions& options,
                         const MachineAddress& machine, const RunTiming& timing,
                         const RunRecords& records)
    : world(options),
      scenario(std::move(loaded)),
      cycle(make_cycle(scenario)),
      twin_force(make_twin_force(
          scenario, connect_remote_machine(scenario, std::string("hapticgiant run ") + version(),
                                           timing.is_fast))),
      twin_base(make_twin_base(scenario)) {
  doctor::check_items(machine.despite);
  if (machine.address.empty()) {
    simulated = make_simulated_device(scenario);
  } else {
    connection = connect_to_run(machine, timing, records.folder, scenario);
    refusal = "the device at " + machine.address + " keeps its own time";
  }
  if (scenario.teleoperation && !scenario.teleoperation->address.udp.empty()) {
    refusal =
        "the remote machine at " + scenario.teleoperation->address.udp + " keeps its own time";
  }
}

page::ShownRun PreparedRun::shown(const std::string& fixed_by) const {
  return {.scenario = &scenario, .options = &world, .refusal = refusal, .fixed_by = fixed_by};
}

}  // namespace hg::scenario
