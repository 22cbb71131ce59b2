/// The one exception type of the project. Thrown at set-up only; nothing throws in the control
/// loop.
#pragma once

#include <stdexcept>

namespace hg {

/// Invalid input: the message names the item, its value, the rule it breaks and, for files,
/// `file:line:column` first. Programs print it and exit with 2.
struct SetupError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace hg
