/// Findings of `hapticgiant check`: as text on stdout, or as JSON.
#pragma once

#include <string>

#include "hg/commissioning/checks/file_check.h"

namespace hg::apps {

int count(const checks::CheckReport& report, checks::Severity severity);

void print(const checks::CheckReport& report);
std::string to_json(const checks::CheckReport& report);

}  // namespace hg::apps
