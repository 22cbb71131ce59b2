#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/hqp/text.h"
#include "tests/fuzz/targets.h"

namespace hg::fuzz {
namespace {

using namespace hqp;

[[noreturn]] void fail(const char* what, const std::string& text) {
  std::fprintf(stderr, "%s\n%s\n", what, text.c_str());
  std::abort();
}

std::string written(const std::vector<RecordedProblem>& problems) {
  std::ostringstream text;
  for (const RecordedProblem& problem : problems) write_problem(text, problem);
  return text.str();
}

}  // namespace

void hqp_reader(Bytes bytes) {
  const std::string text(bytes.begin(), bytes.end());
  std::vector<RecordedProblem> problems;
  try {
    problems = parse_recorded_problems(text, "input");
  } catch (const SetupError& error) {
    const std::string message = error.what();
    if (!message.starts_with("input:")) fail("an error without a place", message);
    return;
  }
  const std::string once = written(problems);
  try {
    const std::string twice = written(parse_recorded_problems(once, "input"));
    if (once != twice) fail("another problem after writing and reading", once + twice);
  } catch (const SetupError& error) {
    fail("what was written is not read", once + error.what());
  }
}

}  // namespace hg::fuzz
