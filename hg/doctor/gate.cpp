#include "hg/doctor/gate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"

namespace hg::doctor {

namespace {

constexpr const char* kLateness = "lateness";

}  // namespace

void check_items(const std::vector<std::string>& despite) {
  std::vector<std::string> items = {kLateness};
  for (const Assessment& line : assess_computer()) items.push_back(line.item);
  for (const std::string& name : despite) {
    if (std::ranges::find(items, name) != items.end()) continue;
    throw SetupError(
        fmt::format("--despite: no item of the doctor is '{}', did you mean '{}'? "
                    "There are {}",
                    name, nearest_name(name, items), fmt::join(items, ", ")));
  }
}

std::string decide(const std::vector<Assessment>& lines, const std::vector<std::string>& despite) {
  std::string passed, refused;
  std::vector<std::string> names;
  for (const Assessment& line : lines) {
    if (line.level != Readiness::kBad) continue;
    const std::string words = fmt::format("{}, {}", line.item, line.found);
    if (std::ranges::find(despite, line.item) != despite.end()) {
      passed += (passed.empty() ? "driven despite " : "; ") + words;
      continue;
    }
    refused += fmt::format("  {}\n    to fix: {}\n", words, line.fix);
    names.push_back(line.item);
  }
  if (names.empty()) return passed;
  throw SetupError(
      fmt::format("this computer must not drive a machine (hapticgiant doctor):\n{}or drive it all "
                  "the same with --despite {}",
                  refused, fmt::join(names, ",")));
}

std::string check_ready(double rate_Hz, const runtime::ThreadOptions& thread,
                        const std::vector<std::string>& despite) {
  constexpr double kOrdinary = 0.5, kRealTime = 1.0;  // s
  std::vector<Assessment> lines = assess_computer();
  const Jitter ordinary = measure_jitter(rate_Hz, kOrdinary, {.priority = 0, .cpu = thread.cpu});
  lines.push_back(assess(ordinary, measure_jitter(rate_Hz, kRealTime, thread), true));
  lines.back().item = kLateness;
  return decide(lines, despite);
}

}  // namespace hg::doctor
