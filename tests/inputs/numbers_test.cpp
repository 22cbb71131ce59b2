// Every number of the shipped files set to absurd values: an error with its place or a run, never a
// crash. A sample of them; HG_ALL_NUMBERS=1 in the environment takes all, in an hour.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "hg/check/device_inspection.h"
#include "hg/check/scenario_inspection.h"
#include "hg/check/twin_inspection.h"
#include "hg/config/simulation/scenario.h"
#include "hg/core/error.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/session.h"
#include "hg/workspace/survey.h"
#include "tests/scenarios/scenario_run.h"

namespace hg {
namespace {

using Texts = std::vector<config::SourceText>;

constexpr std::array<const char*, 7> kValues = {"1e155", "-1e155", "1e6", "1e-155",
                                                "0",     "-1",     "1e-6"};
constexpr int kSampled = 24;       // changed numbers of each scenario
constexpr int kInspectedEach = 8;  // of those that are accepted
constexpr int kCycles = 300;

struct Number {
  std::size_t text, begin, length;
};

// Where numbers stand in YAML and URDF files: behind a colon, in a list or an attribute.
std::vector<Number> numbers_in(const Texts& texts) {
  const std::regex number(
      R"((?:[:,\[] *|"|" *| )([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?=[\s,\]}"]))");
  std::vector<Number> found;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (texts[i].name.ends_with(".stl")) continue;
    const std::string& content = texts[i].content;
    for (std::sregex_iterator at(content.begin(), content.end(), number), end; at != end; ++at) {
      found.push_back(
          {i, static_cast<std::size_t>(at->position(1)), static_cast<std::size_t>(at->length(1))});
    }
  }
  return found;
}

void run(const config::Scenario& scenario) {
  scenario::Session session(scenario);
  scenario::make_summary(scenario);
  for (int k = 0; k < kCycles; ++k) session.advance();
}

void inspect(const config::Scenario& scenario) {
  const workspace::Survey survey = workspace::survey(scenario.device);
  check::inspect(scenario.device, survey);
  check::inspect(scenario.twin, scenario.device.model.dt());
  check::inspect(scenario.device, scenario.twin);
}

class AbsurdNumbers : public testing::TestWithParam<const char*> {};

TEST_P(AbsurdNumbers, AreRefusedOrRun) {
  const bool takes_all = std::getenv("HG_ALL_NUMBERS") != nullptr;
  const Texts shipped_texts = shipped(GetParam()).sources;
  const std::vector<Number> numbers = numbers_in(shipped_texts);
  ASSERT_GT(numbers.size(), 100U);

  std::mt19937 random(7);
  const std::size_t count =
      takes_all ? numbers.size() * kValues.size() : static_cast<std::size_t>(kSampled);
  int accepted = 0, refused = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t draw = takes_all ? k : random() % (numbers.size() * kValues.size());
    const Number& number = numbers[draw / kValues.size()];
    const char* value = kValues[draw % kValues.size()];
    Texts texts = shipped_texts;
    std::string& content = texts[number.text].content;
    const auto line =
        1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(number.begin),
                       '\n');
    const std::string what = texts[number.text].name + ":" + std::to_string(line) + ": " +
                             content.substr(number.begin, number.length) + " -> " + value;
    content.replace(number.begin, number.length, value);
    SCOPED_TRACE(what);
    if (takes_all) std::fprintf(stderr, "%s\n", what.c_str());
    const auto begin = std::chrono::steady_clock::now();
    try {
      const config::Scenario scenario = config::load_scenario(texts);
      run(scenario);
      if (accepted++ % kInspectedEach == 0) inspect(scenario);
    } catch (const SetupError& error) {
      ++refused;
      EXPECT_STRNE(error.what(), "");
      if (takes_all) std::fprintf(stderr, "  %s\n", error.what());
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    if (takes_all && time.count() > 5.0) std::fprintf(stderr, "  SLOW %.1f s\n", time.count());
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(accepted, 0);
}

INSTANTIATE_TEST_SUITE_P(Shipped, AbsurdNumbers,
                         testing::Values("door", "excavator", "free_space", "surfaces"),
                         [](const auto& shown) { return std::string(shown.param); });

}  // namespace
}  // namespace hg
