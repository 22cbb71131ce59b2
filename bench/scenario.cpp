#include "bench/scenario.h"

#include "hg/core/error.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/options.h"

namespace hg::bench {

config::Scenario bench_scenario(const std::string& name) {
  config::Scenario scenario =
      scenario::load({.scenario = name, .plant = "ideal", .sensors = "ideal"});
  if (scenario::planned_duration_s(scenario) == 0.0) {
    throw SetupError(name + ": bench needs a scenario with a script");
  }
  return scenario;
}

}  // namespace hg::bench
