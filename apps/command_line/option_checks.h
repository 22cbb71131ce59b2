/// Checks of numbers on the command line.
#pragma once

#include <functional>
#include <string>

#include "apps/command_line/command.h"

namespace hg::apps {

/// Check that `holds` is true for a number; `rule` completes "must be ...".
OptionCheck number_that(const std::string& rule, const std::function<bool(double)>& holds);

/// The same by a rule that has `words` and `holds`, as scenario::NumberRule.
template <typename Rule>
OptionCheck number_that(const Rule& rule) {
  return number_that(rule.words, rule.holds);
}

OptionCheck at_least(int least);

/// Check for a number within [least, most].
OptionCheck number_within(double least, double most);

/// Check for a whole number within [least, most]; the default of `most` is the largest exact count
/// of a double.
OptionCheck whole_number(double least, double most = 9007199254740992.0);

/// An IPv6 address that stands in brackets, as in a link, without them.
std::string without_brackets(const std::string& text);

}  // namespace hg::apps
