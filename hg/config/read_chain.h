/// Chains from the URDFs that configuration files name.
#pragma once

#include <filesystem>
#include <string>

#include "hg/config/loader.h"
#include "hg/model/chain.h"

namespace hg::config {

/// The text of `urdf`. Throws SetupError with all faults of `file` so far if there is none.
std::string read_urdf(LoaderFile& file, const std::filesystem::path& urdf);

/// The chain in a text of `urdf`. Throws SetupError with all faults of `file` so far if there is
/// none: without a chain no name in the rest of the file means anything.
model::Chain parse_chain(LoaderFile& file, const std::filesystem::path& urdf,
                         const std::string& text, const model::ChainOptions& options);
/// Both at once.
model::Chain read_chain(LoaderFile& file, const std::filesystem::path& urdf,
                        const model::ChainOptions& options);

}  // namespace hg::config
