/// Kind of a configuration file, recognised by its keys.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "hg/config/loader.h"
#include "hg/config/sources.h"

namespace hg::config {

enum class FileKind { kDevice, kTwin, kScenario, kScript, kTool, kSimulation, kMachine };

std::string_view to_string(FileKind kind) noexcept;

/// The kind to which most keys of the file belong. Throws SetupError, "file:line:column: what",
/// when the file is no YAML map or has no key that identifies a kind.
FileKind kind_of(const std::filesystem::path& file, SourceReader& reader);

/// load_file() of a file that must be of this kind: of a URDF, or of a file of another kind, that
/// alone is said.
void load_file_of_kind(FileKind wanted, LoaderFile& file, const std::function<void(Loader&)>& read);

}  // namespace hg::config
