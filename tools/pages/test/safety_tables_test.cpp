#include "tools/pages/safety_tables.h"

#include <gtest/gtest.h>

#include <string>

#include "hg/controller/safety/rules.h"
#include "hg/controller/safety/transitions.h"
#include "hg/core/open_file.h"
#include "tools/pages/configuration_page.h"

namespace hg::pages {
namespace {

using namespace safety;

TEST(SafetyTables, HasEveryRuleAndEveryStateAndEvent) {
  const std::string page = with_safety_tables(read_file("docs/concepts/safety.md"));
  for (const Rule& rule : kRules) {
    const std::string number = std::to_string(static_cast<int>(rule.code));
    EXPECT_NE(page.find("| " + number + " | " + std::string(rule.name) + " |"), std::string::npos);
    EXPECT_NE(page.find(std::string(rule.release)), std::string::npos) << rule.name;
  }
  for (std::size_t i = 0; i < kEventCount; ++i) {
    const std::string event(to_string(static_cast<SafetyEvent>(i)));
    EXPECT_NE(page.find("| " + event + " |"), std::string::npos) << event;
  }
  for (std::size_t i = 0; i < kStateCount; ++i) {
    const std::string state(to_string(static_cast<SafetyState>(i)));
    EXPECT_NE(page.find("| " + state + " |"), std::string::npos) << state;
  }
}

TEST(SafetyTables, ThresholdsAreKeysThatExist) {
  const std::string reference = configuration_page();
  for (const Rule& rule : kRules) {
    const std::string text(rule.threshold);
    for (std::size_t at = text.find("monitor."); at != std::string::npos;
         at = text.find("monitor.", at + 1)) {
      const std::string key = text.substr(at, text.find(',', at) - at);
      EXPECT_NE(reference.find("`" + key + "`"), std::string::npos) << key;
    }
  }
}

}  // namespace
}  // namespace hg::pages
