/// Faults of files as data, and the error that carries them.
#pragma once

#include <string>
#include <vector>

#include "hg/core/error.h"

namespace hg {

/// One fault of a file that a person or another tool has written.
struct InputFault {
  std::string file = {};         ///< as it was opened; empty: no file
  int line = 0;                  ///< counted from 1; 0: the file as a whole
  int column = 0;                ///< counted from 1; 0: the line as a whole
  std::string item = {};         ///< path of a key, as "joints.m1", or "link door"; empty: none
  std::string what = {};         ///< the rule that is broken, and the value
  std::string meant = {};        ///< the name that `what` proposes in place of a wrong one
  bool is_missing_file = false;  ///< the value is the name of a file that does not exist
};

/// "item: what"; without an item, `what` alone.
std::string text_without_place(const InputFault& fault);
/// "file:line:column: item: what", as far as given.
std::string to_text(const InputFault& fault);

/// A SetupError with its faults as data; its message has a line for each.
struct InputError : SetupError {
  explicit InputError(std::vector<InputFault> faults);
  explicit InputError(InputFault fault);

  std::vector<InputFault> faults;  ///< at least one
};

/// The faults of an error. The message of one without data is a fault of no file.
std::vector<InputFault> faults_of(const SetupError& error);

}  // namespace hg
