/// The paper's three experiments in closed loop: Figs. 6, 8 and 9.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/scenarios/scenario_run.h"

namespace hg {
namespace {

constexpr double kSyncMax = 1e-3;  // m, [HANDBOOK] 10.1

void expect_all_events(const ScenarioRun& run) {
  EXPECT_EQ(run.missing(), std::vector<std::string>{});
  EXPECT_TRUE(run.summary().limits_held());
  EXPECT_LT(run.summary().max_sync_error(), kSyncMax);
  EXPECT_EQ(run.summary().fault().code, FaultCode::kNone) << to_string(run.summary().fault().code);
}

TEST(Scenario, TheDoorShowsAllEventsOfFigure9) {
  ScenarioRun run("door");
  double opened_while_locked = 0.0;
  const auto hinge = static_cast<std::size_t>(run.limit("hinge"));
  run.play([&](const Sample& sample) {
    const LimitReport& limit = sample.record.limits[hinge];
    if (limit.cause == LimitCause::kLock) {
      opened_while_locked = std::max(opened_while_locked, std::abs(limit.position));
    }
  });
  expect_all_events(run);
  EXPECT_LE(opened_while_locked, 1e-4);
}

TEST(Scenario, FreeSpaceShowsAllEventsOfFigure6) {
  ScenarioRun run("free_space");
  run.play();
  expect_all_events(run);
}

TEST(Scenario, TheExcavatorShowsAllEventsOfFigure8) {
  ScenarioRun run("excavator");
  run.play();
  expect_all_events(run);
}

TEST(Scenario, TheSameRunGivesTheSameBits) {
  std::vector<std::uint64_t> hashes;
  ScenarioRun first("door");
  first.play([&](const Sample& sample) { hashes.push_back(sample.record.state_hash); }, 3.0);
  ScenarioRun second("door");
  std::size_t i = 0;
  second.play(
      [&](const Sample& sample) {
        ASSERT_LT(i, hashes.size());
        ASSERT_EQ(sample.record.state_hash, hashes[i++]);
      },
      3.0);
  EXPECT_EQ(i, hashes.size());
}

}  // namespace
}  // namespace hg
