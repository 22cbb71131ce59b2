/// Findings of `hapticgiant check`: as text on stdout, or as JSON.
#pragma once

#include <string>
#include <vector>

#include "hg/commissioning/checks/datasheet.h"
#include "hg/commissioning/checks/findings.h"

namespace hg::apps {

struct CheckedFile {
  std::string name;
  std::string kind;
};

struct CheckReport {
  std::vector<CheckedFile> files;
  checks::Findings findings;
  std::vector<checks::Datasheet> datasheets;
};

/// Orders the findings by file and line; duplicates are merged.
void sort_and_merge(CheckReport& report);
int count(const CheckReport& report, checks::Severity severity);

void print(const CheckReport& report);
std::string to_json(const CheckReport& report);

}  // namespace hg::apps
