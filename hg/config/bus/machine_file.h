/// A machine on an EtherCAT bus from its YAML file, described in docs/reference/configuration.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/sources.h"
#include "hg/device/ethercat/machine.h"

namespace hg::config {

/// Loads a machine. `joints` are those of its device, gantry first; empty: any name is accepted,
/// and no slave has a joint. Throws SetupError with all faults of the file, one per line.
ethercat::Machine load_machine(const std::filesystem::path& file, SourceReader& reader,
                               const std::vector<std::string>& joints, Places* places = nullptr);

}  // namespace hg::config
