/// Part of a URDF that becomes a chain.
#pragma once

#include <filesystem>
#include <string>

#include "hg/model/chain_model.h"

namespace hg::new_files {

struct ChainPart {
  std::filesystem::path urdf;
  /// End links of the part in a URDF with branches; empty = the whole URDF
  std::string root_link, tip_link;
};

/// Reads the part as a chain. Throws SetupError as ChainModel::from_urdf_file.
model::ChainModel read_part(const ChainPart& part);

/// Of the frames that at least `degrees` degrees of freedom move, the index of the last one with a
/// name of a held frame (handle, tcp, tool, ...), else of the last one; -1: there are none.
int held_frame(const model::ChainModel& chain, int degrees);

/// Number with two significant digits in usual notation: 0.0023, 1.2, 120.
std::string rounded(double value);

/// A name for YAML, in quotes where needed.
std::string quoted(const std::string& name);

/// Path of the part's URDF as a file in `folder` names it, without symbolic links.
std::string urdf_in(const ChainPart& part, const std::filesystem::path& folder);

/// Lines of a YAML file in `folder`: `urdf:` and, where given, the ends of the part.
std::string part_lines(const ChainPart& part, const std::filesystem::path& folder);

}  // namespace hg::new_files
