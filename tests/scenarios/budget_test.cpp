/// The shipped scenarios with a solver that has to end after one, two or five active sets.

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "tests/scenarios/trace.h"

namespace hg {
namespace {

constexpr double kMore = 1e-3;  // rad or m beyond a limit, above what the same run has without

using Scenario = std::tuple<const char*, const char*>;  // name, law

class SolverBudget : public ::testing::TestWithParam<Scenario> {
 protected:
  static config::Scenario scenario(int budget) {
    const auto& [name, law] = GetParam();
    config::Scenario scenario = scenario::load({.scenario = name, .law = law});
    scenario.device.rendering.solver_budget = budget;
    return scenario;
  }

  static void expect_as_good(const ScenarioRun& run, const ScenarioRun& whole) {
    EXPECT_EQ(run.summary().fault().code, FaultCode::kNone)
        << to_string(run.summary().fault().code);
    EXPECT_EQ(run.missing(), std::vector<std::string>{});
    EXPECT_EQ(run.quality().allocations, 0u);
    EXPECT_LT(run.quality().worst_budget, kBudgetMax);
    const auto device_limits = static_cast<std::size_t>(run.scenario().device.model.limit_count());
    const std::vector<double>& excess = run.summary().truth().worst_excess();
    ASSERT_GE(excess.size(), device_limits);
    for (std::size_t i = 0; i < device_limits; ++i) {
      EXPECT_LE(excess[i], whole.summary().truth().worst_excess()[i] + kMore)
          << run.scenario().limits[i].name;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(, SolverBudget,
                         ::testing::Combine(::testing::Values("door", "excavator", "free_space"),
                                            ::testing::Values("gauss", "paper")),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) + "_" +
                                  std::get<1>(test.param);
                         });

TEST_P(SolverBudget, KeepsTheLimitsOfTheDevice) {
  ScenarioRun whole(scenario(0));
  whole.play();
  ASSERT_EQ(whole.summary().fault().code, FaultCode::kNone);
  for (const int budget : {1, 2, 5}) {
    SCOPED_TRACE(budget);
    ScenarioRun run(scenario(budget));
    run.play();
    expect_as_good(run, whole);
  }
}

}  // namespace
}  // namespace hg
