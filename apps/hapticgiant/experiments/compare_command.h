/// `hapticgiant compare A B`: differences of two recordings, in words.
#pragma once

#include <string>

namespace hg::apps {

struct CompareArguments {
  std::string a, b;
};

/// Exit code: 0 no difference (except computation times), 1 a difference. Throws SetupError for bad
/// input.
int compare(const CompareArguments& arguments);

}  // namespace hg::apps
