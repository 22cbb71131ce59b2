/// Chains from the URDFs that configuration files name.
///
/// Without a chain the fault is reported, and the rest of the file is read without the names of
/// joints and links: LoaderFile::knows_names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/loader.h"
#include "hg/model/chain.h"

namespace hg::config {

/// A URDF that could be read link by link and joint by joint.
struct UrdfText {
  std::filesystem::path file;
  std::string text;
  std::vector<std::string> link_names;
};

/// Reads a URDF. Empty, with a fault reported, if it cannot be read; an empty path was reported
/// before.
std::optional<UrdfText> read_urdf(LoaderFile& file, const std::filesystem::path& urdf);

/// Records that there is no chain, for a reason already reported.
std::optional<model::Chain> no_chain(LoaderFile& file);

/// Name with this index; empty for -1.
std::string name_of(const std::vector<std::string>& names, int index);

/// Builds a chain from the URDF. Empty, with a fault reported, if the URDF holds no such chain.
std::optional<model::Chain> read_chain(LoaderFile& file, const UrdfText& urdf,
                                       const model::ChainOptions& options);

}  // namespace hg::config
