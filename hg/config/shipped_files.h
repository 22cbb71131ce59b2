/// Paths of files shipped with the programs: models, the built page, Python code.
///
/// Code (the page, Python, its interpreter) is only ever taken from the installation, never from
/// the working directory, which may hold untrusted files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/device.h"

namespace hg::config {

/// The folder of this program's viewer/, python/, .venv/ and models/: the sources of the build that
/// contains the program, share/hapticgiant of the prefix whose bin/ contains it, or that of the
/// Python package whose extension this is. Empty if none of them.
std::filesystem::path installation_root();

/// The folder that holds models/: the working directory, or the installation. Throws SetupError
/// when neither has one.
std::filesystem::path models_root();

/// A file that can be chosen, by the name that options take.
struct ShippedFile {
  std::string name;   ///< "door", "fr3/open_drawer", "fr3"
  std::string title;  ///< its title, or its name in the file
};

/// Scenarios, devices and twins of models/, those of the arms last. Throw SetupError where there is
/// no models/.
std::vector<ShippedFile> shipped_scenarios();
std::vector<ShippedFile> shipped_devices();
std::vector<ShippedFile> shipped_twins();

/// Files of users: those in the working directory and in its folders, by their paths. Of a folder
/// with very many files, not all are looked at.
struct LocalFiles {
  std::vector<ShippedFile> scenarios, devices, twins;
};
LocalFiles local_files();

/// Whether a scenario has surfaces of its own.
bool has_surfaces(const std::filesystem::path& scenario);

/// Finds a scenario by file name, or by the name of a shipped one ("door", "fr3/open_drawer").
/// Throws SetupError with the nearest name.
std::filesystem::path find_scenario(const std::string& name);

/// Finds a person's script by file name, or by the name of a shipped one. Throws SetupError with
/// the nearest name.
std::filesystem::path find_script(const std::string& name);

/// A twin file that `reader` has, or the shipped one of this name ("light", "fr3/drawer"). Throws
/// SetupError naming the nearest one.
std::filesystem::path find_twin(const std::string& name, const SourceReader& reader);

/// A scenario file that `reader` has, or the shipped one of this name, whose surfaces are wanted.
/// Throws SetupError naming the nearest one.
std::filesystem::path find_surfaces(const std::string& name, const SourceReader& reader);

/// A device file that `reader` has, or the shipped device of this name ("fr3"). Throws SetupError
/// naming the nearest one.
std::filesystem::path find_device(const std::string& name, const SourceReader& reader);

/// A simulation file, or for NAME the file simulation_NAME.yaml beside that of the device. Throws
/// SetupError naming the nearest one.
std::filesystem::path find_simulation(const std::string& name, const DeviceConfig& device,
                                      const SourceReader& reader);

}  // namespace hg::config
