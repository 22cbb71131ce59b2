#include "hg/signals/operator_desk.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace hg {
namespace {

using Input = OperatorDesk::Input;

constexpr std::int64_t kMs = 1'000'000;

// What the control loop sees at `now_ms`, with a script that does nothing.
SafetyPanel look(OperatorDesk& desk, std::int64_t now_ms) {
  SafetyPanel panel;
  desk.look(now_ms * kMs, panel);
  return panel;
}

TEST(OperatorDesk, LeavesAScriptAloneUntilAPageTakesAnInput) {
  OperatorDesk desk;
  desk.open();
  SafetyPanel panel = {.emergency_stop = true, .operator_enable = false, .override_key = true};
  desk.look(0, panel);
  EXPECT_TRUE(panel.emergency_stop);
  EXPECT_FALSE(panel.operator_enable);
  EXPECT_TRUE(panel.override_key);
  EXPECT_EQ(desk.stops(), 0u);

  desk.set(Input::kOverrideKey, 1, false, 0);
  desk.look(0, panel);
  EXPECT_FALSE(panel.override_key);
  desk.set(Input::kOperatorEnable, 1, true, 0);
  desk.look(0, panel);
  EXPECT_FALSE(panel.operator_enable) << "the script lets go, too";
}

TEST(OperatorDesk, AStopStaysUntilAllWhoPressedItHaveTakenItBack) {
  OperatorDesk desk;
  desk.open();
  desk.press_stop(1);
  desk.press_stop(2);
  EXPECT_FALSE(desk.release_stop(3));
  EXPECT_TRUE(desk.release_stop(1));
  EXPECT_FALSE(desk.release_stop(1));
  EXPECT_TRUE(look(desk, 0).emergency_stop);
  EXPECT_EQ(desk.stop_pressed_by(), std::vector<std::uint64_t>{2});
  desk.leave(2);
  EXPECT_TRUE(look(desk, 0).emergency_stop) << "a page that goes away leaves it pressed";
  desk.open();
  EXPECT_TRUE(look(desk, 0).emergency_stop) << "and so does another run";
  EXPECT_TRUE(desk.release_stop(2));
  EXPECT_FALSE(look(desk, 0).emergency_stop);
}

TEST(OperatorDesk, AStopThatIsReleasedBeforeACycleHasLookedStopsAllTheSame) {
  OperatorDesk desk;
  desk.open();
  desk.press_stop(1);
  EXPECT_TRUE(desk.release_stop(1));
  EXPECT_TRUE(look(desk, 0).emergency_stop);
  EXPECT_FALSE(look(desk, 0).emergency_stop);
}

TEST(OperatorDesk, TheStopOfAScriptIsReleasedByName) {
  OperatorDesk desk;
  desk.open();
  EXPECT_FALSE(desk.release_stop(OperatorDesk::kScript));
  desk.tell_script_stop(true);
  EXPECT_EQ(desk.stop_pressed_by(), std::vector<std::uint64_t>{OperatorDesk::kScript});
  EXPECT_TRUE(desk.release_stop(OperatorDesk::kScript));
  EXPECT_EQ(desk.script_releases(), 1u);
}

TEST(OperatorDesk, ASilentPageLosesItsInputsUntilItTakesThemAgain) {
  for (const Input input : {Input::kOperatorEnable, Input::kOverrideKey}) {
    OperatorDesk desk;
    desk.open();
    const auto is_on = [&](std::int64_t now_ms) {
      const SafetyPanel panel = look(desk, now_ms);
      return input == Input::kOverrideKey ? panel.override_key : panel.operator_enable;
    };
    desk.set(input, 1, true, 0);
    EXPECT_TRUE(is_on(100));
    desk.hear(1, 100 * kMs);
    desk.hear(2, 190 * kMs);  // another page
    EXPECT_TRUE(is_on(200));
    EXPECT_EQ(desk.stops(), 0u);
    EXPECT_FALSE(is_on(201));
    EXPECT_EQ(desk.stops(), 1u);
    EXPECT_EQ(desk.take_lost(), 1u << static_cast<unsigned>(input));
    desk.hear(1, 202 * kMs);
    EXPECT_FALSE(is_on(203)) << "a page that was silent holds nothing";
    desk.set(input, 1, true, 204 * kMs);
    EXPECT_TRUE(is_on(205));
    desk.leave(1);
    EXPECT_FALSE(is_on(206));
    EXPECT_EQ(desk.stops(), 2u);
  }
}

TEST(OperatorDesk, APageThatWasSilentDoesNotHoldWithoutALookInBetween) {
  OperatorDesk desk;
  desk.open();
  desk.set(Input::kOverrideKey, 1, true, 0);
  desk.hear(1, 500 * kMs);  // a paused run: look() was not called
  EXPECT_FALSE(look(desk, 501).override_key);
}

TEST(OperatorDesk, OnePageHoldsASwitchAndAnyOneLetsItGo) {
  OperatorDesk desk;
  desk.open();
  EXPECT_EQ(desk.set(Input::kOverrideKey, 1, true, 0), 0u);
  EXPECT_EQ(desk.set(Input::kOverrideKey, 2, true, 50 * kMs), 1u);
  desk.leave(2);
  EXPECT_TRUE(look(desk, 60).override_key);
  EXPECT_EQ(desk.set(Input::kOverrideKey, 2, false, 60 * kMs), 0u);
  EXPECT_FALSE(look(desk, 60).override_key);
  EXPECT_EQ(desk.set(Input::kOverrideKey, 2, true, 70 * kMs), 0u);
  EXPECT_EQ(desk.set(Input::kOverrideKey, 3, true, 300 * kMs), 0u) << "page 2 is silent";
}

TEST(OperatorDesk, AnotherRunBeginsWithTheScriptsOwnSwitches) {
  OperatorDesk desk;
  desk.open();
  desk.set(Input::kOperatorEnable, 1, false, 0);
  desk.ask_to_end();
  EXPECT_FALSE(look(desk, 0).operator_enable);
  EXPECT_TRUE(desk.end_was_asked());
  desk.close();
  EXPECT_FALSE(desk.is_open());
  desk.open();
  EXPECT_TRUE(look(desk, 0).operator_enable);
  EXPECT_FALSE(desk.end_was_asked());
}

// Two threads as in a run; sanitizers look at it, too.
TEST(OperatorDesk, TheClutchStaysAsItIsWhenItsPageLeavesAndIsClosedInAnotherRun) {
  OperatorDesk desk;
  desk.open();
  EXPECT_FALSE(desk.is_clutch_open());
  desk.set_clutch(true);
  desk.leave(1);
  EXPECT_TRUE(desk.is_clutch_open()) << "nothing moves because a page has gone";
  EXPECT_EQ(desk.stops(), 0u);
  desk.open();
  EXPECT_FALSE(desk.is_clutch_open());
}

TEST(OperatorDesk, AStopThatIsHeldIsSeenInEveryLookWhateverElseIsEdited) {
  OperatorDesk desk;
  desk.open();
  desk.press_stop(1);
  std::atomic<bool> is_over = false;
  std::thread pages([&] {
    for (int i = 0; i < 20'000; ++i) {
      desk.set(Input::kPersonInField, 2, i % 2 == 0, i);
      desk.set(Input::kOverrideKey, 2, i % 3 == 0, i);
      desk.press_stop(2);
      desk.release_stop(2);
      desk.leave(2);
    }
    is_over = true;
  });
  int missing = 0;
  for (std::int64_t now = 0; !is_over; ++now) missing += look(desk, now).emergency_stop ? 0 : 1;
  pages.join();
  EXPECT_EQ(missing, 0);
}

}  // namespace
}  // namespace hg
