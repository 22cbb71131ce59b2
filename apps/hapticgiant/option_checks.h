/// Checks of numbers on the command line.
#pragma once

#include <functional>
#include <string>

#include "hg/scenario/run/plan_options.h"

namespace CLI {
class App;
}

namespace hg::apps {

/// Check for CLI::Option::check: returns the fault of a text; empty = valid.
using OptionCheck = std::function<std::string(const std::string&)>;

/// Check that `holds` is true for a number; `rule` completes "must be ...".
OptionCheck number_that(const std::string& rule, const std::function<bool(double)>& holds);

/// The same by a rule of the library.
OptionCheck number_that(const scenario::NumberRule& rule);

OptionCheck at_least(int least);

/// Check for a number within [least, most].
OptionCheck number_within(double least, double most);

/// Check for a whole number within [least, most]; the default of `most` is the largest exact count
/// of a double.
OptionCheck whole_number(double least, double most = 9007199254740992.0);

/// An IPv6 address that stands in brackets, as in a link, without them.
std::string without_brackets(const std::string& text);

/// Refuses empty texts for all options of a command and its subcommands: an empty text (a variable
/// of a script that is not set) is no file, key or name.
void refuse_empty_values(CLI::App& command);

}  // namespace hg::apps
