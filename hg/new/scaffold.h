/// First versions of configuration files, made from a URDF: what can be read or worked out from it
/// is written down, with a comment that says where it is from; the rest are marked assumptions.
///
/// Set-up only: allocates, and throws SetupError when the URDF cannot be a device or a twin.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hg/config/simulation/simulation.h"
#include "hg/new/chain_part.h"

namespace hg::new_files {

/// How the joints of a manipulator take commands.
enum class Drives {
  kPosition,  ///< positions, and their simulation is as such drives are
  kTorque,    ///< torques, with elastic joints
  kIdeal,     ///< positions that the simulation follows exactly
};

/// Texts of a device.yaml and of the simulation.yaml that it names; no simulation: the drives are
/// ideal, as asked for or because a joint is prismatic.
struct DeviceFiles {
  std::string device;
  std::string simulation;
  std::vector<std::string> news = {};    ///< What a user should know, one line each
  std::vector<std::string> doubts = {};  ///< What its lengths make doubtful, one line each
};

/// A device.yaml that will stand in `folder`, its simulation beside it in `simulation_file`.
/// Leading prismatic joints become the gantry; six or seven joints after them are the manipulator.
/// Capsules are fitted to the meshes of the links, which takes seconds; `progress`, if given, is
/// called after each step of that with the number of steps and the most.
DeviceFiles draft_device(const ChainPart& part, const std::filesystem::path& folder, Drives drives,
                         const std::string& simulation_file,
                         const std::function<void(std::size_t, std::size_t)>& progress = {});

/// Text of a twin.yaml, and what a user should know of its trial on the device; empty: all is well.
struct TwinDraft {
  std::string yaml;
  std::string problem;
  std::string note;   ///< What differs from the mechanism of the URDF; empty: nothing
  std::string doubt;  ///< What its lengths make doubtful; empty: nothing
};

/// A twin.yaml that will stand in `folder`: placed upright where `device` can lead a hand through
/// most of what the twin's joints can do, if possible with no limit of the device in the way;
/// heavier than in its URDF where that alone keeps hand and device from shaking. Takes seconds;
/// `progress`, if given, is called after each trial with the number of trials and the most.
TwinDraft draft_twin(const ChainPart& part, const std::filesystem::path& folder,
                     const config::SimulatedDeviceConfig& device,
                     const std::function<void(std::size_t, std::size_t)>& progress = {});

}  // namespace hg::new_files
