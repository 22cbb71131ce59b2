/// Findings of `hapticgiant check`: as text on stdout, or as JSON.
#pragma once

#include <string>

#include "hg/check/file_check.h"

namespace hg::apps {

int count(const check::CheckReport& report, check::Severity severity);

void print(const check::CheckReport& report);
std::string to_json(const check::CheckReport& report);

}  // namespace hg::apps
