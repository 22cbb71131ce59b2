#include "apps/command_line/option_checks.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/command_line/command.h"

namespace hg::apps {

// The ranges of the library let "nan" through and print all digits of their ends.
OptionCheck number_that(const std::string& rule, const std::function<bool(double)>& holds) {
  return [=](const std::string& text) -> std::string {
    const std::optional<double> value = number_in(text);
    if (!value || !std::isfinite(*value)) return "expected a number, got '" + text + "'";
    return holds(*value) ? "" : "must be " + rule + ", got " + text;
  };
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

}  // namespace hg::apps
