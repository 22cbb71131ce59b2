#include "hg/analysis/timing.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hg::analysis {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Timing, ReportsThePriorityAndWhyThereIsNone) {
  EXPECT_EQ(priority_text({.is_fast = true}), "normal (fast)");
  EXPECT_EQ(priority_text({}), "normal");
  EXPECT_TRUE(has(priority_text({.priority_refusal = "Operation not permitted"}),
                  "SCHED_FIFO refused: Operation not permitted"));
  EXPECT_EQ(priority_text({.priority = 70, .cpu = 3, .is_memory_locked = true, .page_faults = 2}),
            "real time, priority 70, processor 3, memory locked, 2 page faults in the loop");
  EXPECT_TRUE(has(priority_text({.priority = 70}), "memory not locked"));
}

TEST(Timing, ReportsWhyLateCyclesWereOnlyCounted) {
  EXPECT_EQ(timing_lines({}), "");
  Timing timing = {.overruns = 7, .most_overruns_in_a_row = 4};
  EXPECT_TRUE(has(timing_lines(timing),
                  "7 cycles of this computer, at most 4 in a row; counted only: the thread"));
  timing.priority = 80;
  EXPECT_TRUE(has(timing_lines(timing), "counted only: the device waits"));
  timing.overruns_stop = true;
  EXPECT_FALSE(has(timing_lines(timing), "counted only"));
  timing.is_fast = true;
  EXPECT_EQ(timing_lines(timing), "");
}

TEST(Timing, ReportsWakeUpsStagesAndTheirHistogram) {
  Timing timing = {.priority = 80, .stages = {{"solver", {1.5, 3.0, 9.0}}}};
  for (int i = 0; i < 99; ++i) timing.wake_up_us.add(4.0);
  timing.wake_up_us.add(70.0);
  const std::string text = timing_lines(timing);
  EXPECT_TRUE(has(text, "99.00 % within 10 us, 100.00 % within 100 us")) << text;
  EXPECT_TRUE(has(text, "solver 1.5 us (medians)")) << text;
  nlohmann::ordered_json json;
  add_to(json, timing);
  EXPECT_EQ(json["stage_time_us"]["solver"]["max"], 9.0);
  std::uint64_t count = 0;
  for (const auto& bin : json["wake_up_us"]["histogram"]) count += bin["count"].get<int>();
  EXPECT_EQ(count, 100u);
  EXPECT_EQ(json["wake_up_us"]["histogram"].back()["below"], 100.0);
}

}  // namespace
}  // namespace hg::analysis
