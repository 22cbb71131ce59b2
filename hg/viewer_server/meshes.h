/// Mesh files referenced by a URDF, added to the assets that a page can fetch.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hg/viewer_server/access.h"

namespace hg::viewer_server {

/// Addresses of meshes, by their names in a URDF.
using MeshAddresses = std::map<std::string, std::string, std::less<>>;

/// Returns `text`, the URDF that is or was the file `urdf`, with the name of every mesh that was
/// found replaced by the address `folder`N.stl or .dae, and adds those meshes to `assets` and
/// `addresses`. Search
/// path: relative names beside the URDF; package://NAME/PATH in the folders above it, and in those
/// of ROS_PACKAGE_PATH. A mesh that is not found keeps its name: the page draws bars instead.
std::string with_meshes(const std::filesystem::path& urdf, const std::string& text,
                        std::string_view folder, AssetTable& assets, MeshAddresses& addresses);

/// Names of the meshes in `text` that with_meshes() does not find, each once.
std::vector<std::string> missing_meshes(const std::filesystem::path& urdf, const std::string& text);

}  // namespace hg::viewer_server
