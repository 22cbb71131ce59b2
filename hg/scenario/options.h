/// Loads a scenario, by name or from a recording, with what stands in it replaced by options.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"

namespace hg::scenario {

/// What replaces parts of a scenario: device, person, twin, surfaces, simulation and law.
struct ScenarioOptions {
  std::string scenario = "door";  ///< file, or name of a shipped one
  std::string device;             ///< device.yaml instead of the scenario's; empty = its own
  std::string twin;               ///< twin.yaml instead of the scenario's; empty = its own
  /// Scenario whose surfaces replace the scenario's, or "none"; empty = its own
  std::string surfaces;
  /// User: see config::find_script(), or "mouse" or "none"; empty = the scenario's
  std::string user;
  std::optional<double> rate_Hz;  ///< rate; unset = the device's
  std::string plant;              ///< plant, "elastic" or "ideal"; empty = as the device is
  /// Simulation, see config::find_simulation(); empty = that of the device
  std::string simulation;
  std::string sensors;  ///< sensors, "real" or "ideal"; empty = as the device's simulation
  std::string hand;     ///< hand, "relaxed", "normal" or "stiff"; empty = the script's
  std::optional<std::uint64_t> seed;  ///< seed of the simulation
  std::optional<double> step_s;       ///< largest step of the plant
  std::string law;                    ///< preset, see config::LawPreset; empty = the device's
  /// Values for keys of the files, "PART.KEY=VALUE"; a part is scenario, device, simulation, twin
  /// or script: "twin.joints.hinge.damping_Nms_per_rad=2"
  std::vector<std::string> changes;
};

/// Loads the scenario and applies the options. Throws SetupError, which names an option as the
/// command line does: "--plant elastic: ...".
config::Scenario load(const ScenarioOptions& options);

/// The options that change what the scenario says, one per line, for load_recorded().
std::string to_text(const ScenarioOptions& options);

/// Hash of these texts, without their names: 16 hexadecimal digits, FNV-1a.
std::string hash_of(const std::vector<config::SourceText>& sources);

/// The scenario from the files that a recording holds, and the text of its options; the disk is not
/// touched. The files have the values of --set already. Throws SetupError.
config::Scenario load_recorded(std::vector<config::SourceText> sources, const std::string& options);

}  // namespace hg::scenario
