/// `hapticgiant identify payload [FILE...]`: the payload beyond the force/torque sensor, from poses
/// at rest: of the simulated device, which takes them on its own, or from CSV files. `hapticgiant
/// identify friction RECORDING`: the friction of each joint, from a run. `hapticgiant identify
/// joints RECORDING`: stiffness and damping of each joint, or the delay of its drive. `hapticgiant
/// identify inertia RECORDING`: inertial parameters of the links.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/simulation/simulation.h"
#include "hg/identify/figure.h"
#include "hg/recording/recording_reader.h"

namespace hg::apps {

class Command;

struct IdentifyRecordingArguments {
  std::string file;    ///< recording file
  std::string device;  ///< device.yaml; empty = that of the recording
  std::string json;    ///< file for all figures; empty = none
};

/// The device that --device names; nothing without it. Throws SetupError.
std::optional<config::SimulatedDeviceConfig> given_device(
    const IdentifyRecordingArguments& arguments);

/// What was identified from a recording, for --json and python/hapticgiant/report/identify.py.
/// Throws SetupError.
nlohmann::ordered_json identify_friction(const IdentifyRecordingArguments& arguments);
nlohmann::ordered_json identify_joints(const IdentifyRecordingArguments& arguments);
nlohmann::ordered_json identify_inertia(const IdentifyRecordingArguments& arguments);

/// A number, if it was found, beside that of the files, which has the name `file_key`.
nlohmann::ordered_json figure_json(const identify::Figure& figure, const char* file_key,
                                   double in_file);

/// The beginning of all of them.
template <typename Recorded>
nlohmann::ordered_json recorded_json(const char* identified, const Recorded& recorded) {
  return {{"kind", "identify"},
          {"identified", identified},
          {"losses", recording::to_text(recorded.losses)},
          {"used_s", recorded.used_s},
          {"joints", nlohmann::ordered_json::array()}};
}

/// Adds the subcommands to the program; running it sets `exit_code`.
void add_identify(Command app, int& exit_code);

}  // namespace hg::apps
