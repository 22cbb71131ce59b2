#include "hg/doctor/gate.h"

#include <gtest/gtest.h>

#include "hg/core/test/message_of.h"

namespace hg::doctor {
namespace {

const std::vector<Assessment> kLate = {
    {.item = "kernel", .found = "6.1"},
    {.level = Readiness::kWarn, .item = "governor", .found = "powersave", .fix = "cpupower"},
    {.level = Readiness::kBad, .item = "lateness", .found = "max 900 us", .fix = "see above"}};

TEST(Gate, OnlyBadLinesAreInTheWay) {
  EXPECT_EQ(decide({kLate[0], kLate[1]}, {}), "");
  EXPECT_EQ(message_of([] { decide(kLate, {}); }),
            "this computer must not drive a machine (hapticgiant doctor):\n"
            "  lateness, max 900 us\n    to fix: see above\n"
            "or drive it all the same with --despite lateness");
}

TEST(Gate, IsOverruledByName) {
  EXPECT_EQ(decide(kLate, {"lateness"}), "driven despite lateness, max 900 us");
  EXPECT_EQ(decide(kLate, {"lateness", "kernel"}), "driven despite lateness, max 900 us");
  EXPECT_NE(message_of([] { decide(kLate, {"governor"}); }).find("--despite lateness"),
            std::string::npos);
}

TEST(Gate, NamesTheNearestItem) {
  EXPECT_EQ(
      message_of([] {
        check_items({"kernel", "latenes"});
      }),
      "--despite: no item of the doctor is 'latenes', did you mean 'lateness'? There are "
      "lateness, kernel, priority, memory, swap, governor, idle, processors, interrupts, clock, "
      "machine, throttling");
  EXPECT_NO_THROW(check_items({"lateness", "throttling"}));
}

TEST(Gate, MeasuresTheLatenessOfThisComputer) {
  EXPECT_NO_THROW(check_ready(1000.0, {.priority = 0}, {"lateness", "priority", "memory"}));
}

}  // namespace
}  // namespace hg::doctor
