/// Checks configuration files of any kind, each alone and together: whatever can be loaded is
/// inspected, and what cannot becomes a finding.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/check/datasheet.h"
#include "hg/check/findings.h"
#include "hg/config/device.h"

namespace hg::check {

struct CheckedFile {
  std::string name;
  std::string kind;
};

struct CheckReport {
  std::vector<CheckedFile> files;
  Findings findings;  ///< by file and line, each once
  std::vector<Datasheet> datasheets;
  /// The first device that could be loaded, else that of the first scenario
  std::optional<config::DeviceConfig> first_device;
};

/// Checks the files. Never throws SetupError: a file that cannot be read is a finding.
CheckReport check_files(const std::vector<std::string>& files);

}  // namespace hg::check
