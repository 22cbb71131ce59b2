// What becomes of the figures where the device stops in every measurement.

#include "hg/studies/haptify/groups.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hg::haptify {
namespace {

TEST(Groups, MeasurementsThatFailAreToldAndGiveNoFigure) {
  config::Scenario scenario = config::load_scenario("models/scenarios/walk.yaml");
  scenario.device.monitor.force_max = 0.05;  // N: nobody can hold it
  const HaptifyOptions options = {.repetitions = 2, .is_quick = true};
  for (const auto& [add, begin] :
       {std::pair(&add_free_space, "free space, body of 6 kg, seed 1: "),
        std::pair(&add_dynamics, "strokes, "), std::pair(&add_sliding, "frictionless surface, "),
        std::pair(&add_stiffness, "stiffness 2000 N/m, seed 1: "),
        std::pair(&add_peak, "peak force, seed 1: "), std::pair(&add_z_width, "Z-width, 6 kg, "),
        std::pair(&add_transparency, "transparency along x: "),
        std::pair(&add_force_response, "force response along x: "),
        std::pair(&add_latency, "latency, axis 0, seed 1: "),
        std::pair(&add_impacts, "impact, normal hand, 0.5 kg, 0.2 m/s on 2000 N/m: "),
        std::pair(&add_felt_mass, "felt mass, 20 N along axis 0, seed 1: "),
        std::pair(&add_rotation, "rotation, normal hand, 0.005 kg m^2: "),
        std::pair(&add_springs, "spring of 500 Nm/rad from 2 mm, seed 1: ")}) {
    SCOPED_TRACE(begin);
    Benchmark out;
    const Told told;
    add({scenario, options, told, out});
    ASSERT_FALSE(out.failures.empty());
    EXPECT_EQ(out.failures.front().rfind(begin, 0), 0u) << out.failures.front();
    for (const auto* figures : {&out.table, &out.beyond}) {
      for (const Figure& figure : *figures) EXPECT_FALSE(figure.is_measured()) << figure.id;
    }
  }
}

}  // namespace
}  // namespace hg::haptify
