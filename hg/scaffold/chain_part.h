/// Which part of a URDF becomes a chain.
#pragma once

#include <filesystem>
#include <string>

#include "hg/model/chain.h"

namespace hg::scaffold {

struct ChainPart {
  std::filesystem::path urdf;
  std::string root_link, tip_link;  ///< of a URDF with branches; empty: the whole URDF
};

/// Throws SetupError as Chain::from_urdf_file.
model::Chain read_part(const ChainPart& part);

/// The last frame whose name says that it is held (handle, tcp, tool, ...), else the last frame.
int held_frame(const model::Chain& chain);

/// Two significant digits, the way people write them: 0.0023, 1.2, 120.
std::string rounded(double value);

/// A name as YAML reads it back: in quotes where it needs them.
std::string quoted(const std::string& name);

/// `urdf:` and, where given, the ends of the part, as lines of a YAML file that stands in `folder`.
std::string part_lines(const ChainPart& part, const std::filesystem::path& folder);

}  // namespace hg::scaffold
