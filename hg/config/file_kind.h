/// Kind of a configuration file, recognised by its keys.
#pragma once

#include <filesystem>
#include <string_view>

#include "hg/config/sources.h"

namespace hg::config {

enum class FileKind { kDevice, kTwin, kScenario, kScript, kTool, kSimulation, kMachine };

std::string_view to_string(FileKind kind) noexcept;

/// The kind to which most keys of the file belong. Throws SetupError, "file:line:column: what",
/// when the file is no YAML map or has no key that identifies a kind.
FileKind kind_of(const std::filesystem::path& file, SourceReader& reader);

}  // namespace hg::config
