/// Which kind of configuration file a file is, told from its keys.
#pragma once

#include <filesystem>
#include <string_view>

#include "hg/config/sources.h"

namespace hg::config {

enum class FileKind { kDevice, kTwin, kScenario, kScript, kTool, kSimulation };

std::string_view to_string(FileKind kind) noexcept;

/// The kind that has the most keys of the file as its own. Throws SetupError, "file:line:column:
/// what", when the file is no YAML map or has no key that tells.
FileKind kind_of(const std::filesystem::path& file, SourceReader& reader);

}  // namespace hg::config
