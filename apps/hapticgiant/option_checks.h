/// What is checked of numbers on the command line.
#pragma once

#include <functional>
#include <string>

namespace hg::apps {

/// For CLI::Option::check: what is wrong with a text; empty = nothing.
using OptionCheck = std::function<std::string(const std::string&)>;

/// `rule` completes "must be ...".
OptionCheck number_that(const std::string& rule, const std::function<bool(double)>& holds);

OptionCheck at_least(int least);

/// Both ends belong to it.
OptionCheck number_within(double least, double most);

/// Both ends belong to it; the largest default is what a double can count to.
OptionCheck whole_number(double least, double most = 9007199254740992.0);

}  // namespace hg::apps
