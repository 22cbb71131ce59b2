/// `hapticgiant compare A B`: what is different in two recordings, in words.
#pragma once

#include <string>

namespace hg::apps {

struct CompareArguments {
  std::string a, b;
};

/// Exit code: 0 nothing differs (times of computation aside), 1 something does. Throws SetupError
/// for bad input.
int compare(const CompareArguments& arguments);

}  // namespace hg::apps
