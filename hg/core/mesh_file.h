/// Where the mesh files of a URDF are.
#pragma once

#include <filesystem>
#include <string_view>

namespace hg {

/// The file that the URDF `urdf` refers to by `name`; empty when there is none. Search path:
/// relative names beside the URDF; package://NAME/PATH in the folders above it, and in those of
/// ROS_PACKAGE_PATH.
std::filesystem::path find_mesh(const std::filesystem::path& urdf, std::string_view name);

}  // namespace hg
