/// Where the program finds its own data: models and the built page.
#pragma once

#include <filesystem>
#include <string>

namespace hg::apps {

/// The folder that holds models/ and viewer/: the working directory, or one above the program.
/// Throws SetupError when there is none.
std::filesystem::path data_root();

/// A scenario by file name, or by the name of one that comes with the program ("door").
/// Throws SetupError naming the nearest one.
std::filesystem::path find_scenario(const std::string& name);

}  // namespace hg::apps
