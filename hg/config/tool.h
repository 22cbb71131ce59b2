/// A tool, held by the user, from its YAML file, described in docs/reference/configuration.md.
#pragma once

#include <filesystem>
#include <string>

#include "hg/config/sources.h"
#include "hg/core/types.h"
#include "hg/model/chain_model.h"

namespace hg::config {

struct Tool {
  std::string name;
  model::Tool body;  ///< body of the tool, without its link
  Pose T_H_S;        ///< force/torque sensor S in the handle frame H
  bool has_dead_man = true;
};

/// Loads a tool. Throws SetupError with all faults of the file, one per line.
Tool load_tool(const std::filesystem::path& file, SourceReader& reader);

}  // namespace hg::config
