// Whatever a file contains, loading it ends with a result or with SetupError.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>
#include <utility>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/core/error.h"

namespace hg::config {
namespace {

TEST(DamagedText, EndsWithAResultOrASetupError) {
  const std::vector<SourceText> good = load_scenario("models/scenarios/door.yaml").sources;
  const std::string marks = "[]{}:,-#&*!|>'\"%@`? \n\t0.~ainf";
  const bool holds = rc::check("damaged text is refused or read", [&] {
    std::vector<SourceText> recorded = good;
    const int edits = *rc::gen::inRange(1, 6);
    for (int i = 0; i < edits; ++i) {
      std::string& text = recorded[*rc::gen::inRange<std::size_t>(0, recorded.size())].content;
      const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
      switch (*rc::gen::inRange(0, 3)) {
        case 0:
          text[at] = *rc::gen::elementOf(marks);
          break;
        case 1:
          text.insert(at, 1, *rc::gen::elementOf(marks));
          break;
        default:
          text.erase(at, *rc::gen::inRange<std::size_t>(1, 20));
      }
    }
    try {
      load_scenario(std::move(recorded));
    } catch (const SetupError& error) {
      RC_ASSERT(!std::string(error.what()).empty());
    }
  });
  EXPECT_TRUE(holds);
}

}  // namespace
}  // namespace hg::config
