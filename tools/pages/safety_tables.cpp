#include "tools/pages/safety_tables.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <initializer_list>
#include <string_view>

#include "hg/controller/safety/rules.h"
#include "hg/controller/safety/transitions.h"
#include "tools/pages/marks.h"

namespace hg::pages {
namespace {

using namespace safety;

void add(std::string& text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) text.append(part);
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

void add_cell(std::string& text, const Transition& transition, SafetyState state) {
  if (transition.refusal != Refusal::kNone) {
    add(text, {" refused |"});
  } else if (transition.next == state) {
    add(text, {" - |"});
  } else {
    add(text, {" **", to_string(transition.next), "** |"});
  }
}

std::string transitions_table() {
  std::string text = "| event |";
  std::string line = "| --- |";
  for (std::size_t s = 0; s < kStateCount; ++s) {
    add(text, {" ", to_string(static_cast<SafetyState>(s)), " |"});
    add(line, {" --- |"});
  }
  add(text, {"\n", line, "\n"});
  for (std::size_t e = 0; e < kEventCount; ++e) {
    const auto event = static_cast<SafetyEvent>(e);
    add(text, {"| ", to_string(event), " |"});
    for (std::size_t s = 0; s < kStateCount; ++s) {
      const auto state = static_cast<SafetyState>(s);
      add_cell(text, transition(state, event), state);
    }
    add(text, {"\n"});
  }
  return text;
}

// keys of device.yaml as code
std::string threshold(const Rule& rule) {
  std::string text;
  std::string_view rest = rule.threshold;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(", "), rest.size());
    const std::string_view part = rest.substr(0, end);
    const bool is_key = part.find("_") != std::string_view::npos && part.find('.') != part.npos &&
                        part.find(' ') == std::string_view::npos;
    const std::string_view quote = is_key ? "`" : "";
    add(text, {text.empty() ? "" : ", ", quote, part, quote});
    rest.remove_prefix(std::min(end + 2, rest.size()));
  }
  return text;
}

std::string debounce(const Debounce& debounce) {
  std::string text;
  if (debounce.seconds > 0.0) {
    add(text, {number(1e3 * debounce.seconds), " ms"});
  } else if (debounce.samples == 1) {
    text = "at once";
  } else {
    add(text, {number(debounce.samples), " samples"});
  }
  return text;
}

std::string rules_table() {
  std::string text =
      "| number | rule | threshold | warning from | for | reaction |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const Rule& rule : kRules) {
    const std::string warning = rule.warn_from < 1.0 ? number(100.0 * rule.warn_from) : "";
    add(text, {"| ", number(static_cast<double>(rule.code)), " | ", rule.name, " | ",
               threshold(rule), " | ", warning, warning.empty() ? "-" : " %", " | ",
               debounce(rule.debounce), " | ", to_string(rule.reaction), " |\n"});
  }
  return text;
}

std::string stops_list() {
  std::string text;
  for (const Rule& rule : kRules) {
    add(text, {"- **", number(static_cast<double>(rule.code)), " ", rule.name, ".** ", rule.meaning,
               " Released: ", rule.release, ".\n"});
  }
  return text;
}

}  // namespace

std::string with_safety_tables(std::string page) {
  replace_marked(page, "transitions", transitions_table());
  replace_marked(page, "rules", rules_table());
  replace_marked(page, "stops", stops_list());
  return page;
}

}  // namespace hg::pages
