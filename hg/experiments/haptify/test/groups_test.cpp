// What becomes of the runs where the device stops in every measurement.

#include "hg/experiments/haptify/groups.h"

#include <gtest/gtest.h>

namespace hg::haptify {
namespace {

TEST(Groups, EveryRunThatFailsSaysSo) {
  config::Scenario scenario = config::load_scenario("models/scenarios/walk.yaml");
  scenario.device.monitor.force_max = 0.05;  // N: no person can hold it
  const HaptifyOptions options = {.repetitions = 2, .is_quick = true};
  const experiments::Place place = experiments::place_of(scenario.device);
  for (const auto add : {add_free_space, add_sources, add_dynamics, add_sliding, add_stiffness,
                         add_peak, add_z_width, add_transparency, add_force_response, add_latency,
                         add_impacts, add_felt_mass, add_rotation, add_springs}) {
    Benchmark out;
    experiments::Runs runs;
    add({scenario, options, runs, out, place});
    EXPECT_TRUE(out.has_failures);
    for (const auto& [name, measurement] : out.measurements.items()) {
      SCOPED_TRACE(name);
      ASSERT_FALSE(measurement["runs"].empty());
      for (const nlohmann::json& run : measurement["runs"]) {
        EXPECT_NE(run.at(run.contains("failure") ? "failure" : "end"), "") << run.dump();
      }
    }
  }
}

}  // namespace
}  // namespace hg::haptify
