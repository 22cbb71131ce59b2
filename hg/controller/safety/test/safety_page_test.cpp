#include "hg/controller/safety/safety_page.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "hg/controller/safety/rules.h"
#include "hg/controller/safety/transitions.h"

namespace hg::safety {
namespace {

constexpr const char* kPage = "docs/concepts/safety.md";

std::string read(const char* file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// HG_UPDATE_DOCS=1 in the environment writes the tables instead of comparing them
TEST(SafetyPage, CommittedTablesAreCurrent) {
  const std::string committed = read(kPage);
  const std::string expected = with_tables(committed);
  if (std::getenv("HG_UPDATE_DOCS") != nullptr) std::ofstream(kPage) << expected;
  EXPECT_EQ(read(kPage), expected) << "run safety_test with HG_UPDATE_DOCS=1 and commit " << kPage;
}

TEST(SafetyPage, HasEveryRuleAndEveryStateAndEvent) {
  const std::string page = with_tables(read(kPage));
  for (const Rule& rule : kRules) {
    const std::string number = std::to_string(static_cast<int>(rule.code));
    EXPECT_NE(page.find("| " + number + " | " + std::string(rule.name) + " |"), std::string::npos);
    EXPECT_NE(page.find(std::string(rule.release)), std::string::npos) << rule.name;
  }
  for (std::size_t i = 0; i < kEventCount; ++i) {
    const std::string event(to_string(static_cast<Event>(i)));
    EXPECT_NE(page.find("| " + event + " |"), std::string::npos) << event;
  }
  for (std::size_t i = 0; i < kStateCount; ++i) {
    const std::string state(to_string(static_cast<State>(i)));
    EXPECT_NE(page.find("| " + state + " |"), std::string::npos) << state;
  }
}

TEST(SafetyPage, ThresholdsAreKeysThatExist) {
  const std::string reference = read("docs/reference/configuration.md");
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
}  // namespace hg::safety
