// Hands that are drawn and varied, and their files.

#include "hg/experiments/hand_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hg/core/test/temporary_folder.h"

namespace hg::experiments {
namespace {

TEST(HandSearch, OrdersHandsByHowNearTheyCameAndKeepsWhatCanBePlayedAgain) {
  const TemporaryFolder folder;
  const HandSearch search = {
      .world = {.scenario = "fr3/move_tool"}, .folder = folder.path(), .count = 4, .force = 30.0};
  const std::vector<TriedHand> tried = search_hands(search, {});
  ASSERT_EQ(tried.size(), 4u);
  EXPECT_TRUE(std::ranges::is_sorted(tried, std::ranges::greater{},
                                     [](const TriedHand& hand) { return badness(hand.run); }));

  const TriedHand& worst = tried.front();
  const Trial again = {
      .name = "again",
      .hand = "",
      .scenario = scenario::load({.scenario = (folder.path() / (worst.name + ".yaml")).string()})};
  const SeededRun run = play_seeds({again}, 1, 1, {}).front();
  EXPECT_EQ(run.length.excess, worst.run.length.excess);
  EXPECT_EQ(run.vibration, worst.run.vibration);

  remove_files(search, worst);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / (worst.name + ".yaml")));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / (worst.name + "_person.yaml")));
}

TEST(HandSearch, CountsWhatIsBeyondTheToleranceAndAFault) {
  SeededRun run;
  EXPECT_EQ(badness(run), 0.0);
  run.length.excess = 3e-3;
  run.angle.excess = 2e-3;
  EXPECT_DOUBLE_EQ(badness(run), 3.0);
  run.fault.code = FaultCode::kLimitExceeded;
  EXPECT_DOUBLE_EQ(badness(run), 4.0);
}

}  // namespace
}  // namespace hg::experiments
