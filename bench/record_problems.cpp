/// Writes the problems that a scenario gives to the solver, one per cycle, for hqp_benchmark.
///
///   record_problems FOLDER SCENARIO...
///
/// makes FOLDER/gauss_SCENARIO.hqp for the law `gauss` with recoverable bounds, from a run on the
/// simulated device.
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>

#include "apps/hapticgiant/run_setup.h"
#include "hg/assembly/assembly.h"
#include "hg/hqp/text.h"
#include "hg/runtime/requests.h"

namespace hg {
namespace {

void record(const std::string& name, const std::filesystem::path& folder) {
  const config::Scenario scenario =
      apps::make_scenario({.scenario = name, .law = "gauss", .bounds = "recoverable"});
  cycle::Cycle cycle = assembly::make_cycle(scenario);
  device::SimulatedDevice device = assembly::make_simulated_device(scenario);
  const double end = assembly::planned_duration_s(scenario);
  std::ofstream file(folder / ("gauss_" + name + ".hqp"));
  const auto sample = std::make_unique<Sample>();
  do {
    device.read(sample->sensors);
    cycle.step(sample->sensors, sample->operator_input, sample->command, sample->record);
    device.write(sample->command);
    const CycleRecord& record = sample->record;
    sample->operator_input.request =
        runtime::next_request(record.mode, sample->sensors.dead_man, false);
    if (record.mode == Mode::kRunning) hqp::write_problem(file, cycle.problem());
  } while (sample->record.time_s < end && sample->record.mode != Mode::kFault);
}

}  // namespace
}  // namespace hg

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: record_problems FOLDER SCENARIO...\n";
    return 1;
  }
  try {
    for (int i = 2; i < argc; ++i) hg::record(argv[i], argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
