/// A scripted hand from its YAML file: script.yaml, described in docs/reference/configuration.md.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "hg/config/sources.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/simulator/person/person.h"
#include "hg/simulator/person/script.h"

namespace hg::config {

struct Script {
  person::HandImpedance hand;
  person::Script script;
  /// Pose channels whose start value is in the file. The others start where the twin starts and are
  /// filled in when the run is built.
  std::array<bool, person::kPoseChannels> start_given{};
  std::vector<SourceText> sources;
};

/// Loads a script. The channels of frame twin_joints are the joints of `twin`. Throws SetupError
/// with all faults of the file, one per line.
Script load_script(const std::filesystem::path& file, const rendering::TwinModel& twin);
Script load_script(const std::filesystem::path& file, const rendering::TwinModel& twin,
                   SourceReader& reader);

}  // namespace hg::config
