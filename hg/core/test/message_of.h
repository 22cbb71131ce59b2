// What a set-up error says to the user.
#pragma once

#include <string>

#include "hg/core/error.h"

namespace hg {

/// Message of the SetupError that `action` throws.
std::string message_of(const auto& action) {
  try {
    action();
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace hg
