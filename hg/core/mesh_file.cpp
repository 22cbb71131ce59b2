#include "hg/core/mesh_file.h"

#include <cstdlib>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

namespace hg {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";
constexpr std::string_view kFile = "file://";

// folders that may contain a package
std::vector<fs::path> package_folders(const fs::path& urdf) {
  std::vector<fs::path> folders;
  std::error_code error;
  const fs::path start = fs::absolute(urdf, error).parent_path();
  for (fs::path folder = start; folder.has_relative_path(); folder = folder.parent_path()) {
    folders.push_back(folder.parent_path());
  }
  const char* listed = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream list(listed == nullptr ? "" : listed);
  for (std::string folder; std::getline(list, folder, ':');) folders.emplace_back(folder);
  return folders;
}

}  // namespace

fs::path find_mesh(const fs::path& urdf, std::string_view name) {
  std::vector<fs::path> candidates;
  if (name.starts_with(kPackage)) {
    for (const fs::path& folder : package_folders(urdf)) {
      candidates.push_back(folder / name.substr(kPackage.size()));
    }
  } else if (name.starts_with(kFile)) {
    candidates.emplace_back(name.substr(kFile.size()));
  } else {
    candidates.push_back(urdf.parent_path() / name);
  }
  for (const fs::path& file : candidates) {
    std::error_code error;
    if (fs::is_regular_file(file, error)) return file;
  }
  return {};
}

}  // namespace hg
