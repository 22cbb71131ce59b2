#include "hg/scenario/options.h"

#include <gtest/gtest.h>

#include <string>

#include "hg/core/test/message_of.h"

namespace hg::scenario {
namespace {

TEST(Options, ARecordingKeepsThoseThatDetermineTheCycle) {
  const ScenarioOptions options = {
      .scenario = "door", .rate_Hz = 500.0, .law = "paper", .bounds = "paper"};
  EXPECT_EQ(to_text(options), "--rate-hz 500\n--law paper\n--bounds paper\n");
  const config::Scenario recorded =
      load_recorded(load({.scenario = "door"}).sources, to_text(options));
  EXPECT_EQ(recorded.device.model.rate_Hz, 500.0);
  EXPECT_EQ(recorded.device.rendering.law, rendering::Law::kPaper);
  EXPECT_EQ(recorded.device.rendering.bounds, rendering::Bounds::kPaper);
}

TEST(Options, AnUnknownNameIsRefusedWithItsOption) {
  EXPECT_EQ(message_of([] { load({.scenario = "door", .law = "gaus"}); }),
            "--law: expected one of the names of --help, got 'gaus'");
  EXPECT_NE(message_of([] { load({.scenario = "dor"}); }).find("did you mean 'door'?"),
            std::string::npos);
}

}  // namespace
}  // namespace hg::scenario
