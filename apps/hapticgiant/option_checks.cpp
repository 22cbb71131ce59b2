#include "apps/hapticgiant/option_checks.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

namespace hg::apps {

// CLI11's ranges let "nan" through and print all digits of their ends.
OptionCheck number_that(const std::string& rule, const std::function<bool(double)>& holds) {
  return [=](const std::string& text) -> std::string {
    double value = 0.0;
    if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value)) {
      return "expected a number, got '" + text + "'";
    }
    return holds(value) ? "" : "must be " + rule + ", got " + text;
  };
}

OptionCheck number_that(const scenario::NumberRule& rule) {
  return number_that(rule.words, rule.holds);
}

OptionCheck at_least(int least) {
  return number_that(fmt::format("at least {}", least), [=](double v) { return v >= least; });
}

OptionCheck number_within(double least, double most) {
  return number_that(fmt::format("from {:g} to {:g}", least, most),
                     [=](double v) { return v >= least && v <= most; });
}

OptionCheck whole_number(double least, double most) {
  return number_that(fmt::format("a whole number from {:.0f} to {:.0f}", least, most),
                     [=](double v) { return v >= least && v <= most && v == std::floor(v); });
}

std::string without_brackets(const std::string& text) {
  const bool has_both = text.size() > 2 && text.starts_with('[') && text.ends_with(']');
  return has_both ? text.substr(1, text.size() - 2) : text;
}

void refuse_empty_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() > 0) {
      option->check(
          [](const std::string& text) { return text.empty() ? "must not be empty" : ""; });
    }
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
}

}  // namespace hg::apps
