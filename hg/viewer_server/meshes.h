/// The mesh files that a URDF draws, put into the table of what a page may fetch.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "hg/viewer_server/access.h"

namespace hg::viewer_server {

/// `text`, the URDF that is or was the file `urdf`, in which every mesh that was found has the
/// address `folder`N.stl or .dae, and those meshes in `assets`. Looked for: relative names beside
/// the URDF; package://NAME/PATH in the folders above it, and in those of ROS_PACKAGE_PATH. What is
/// not found keeps its name: the page draws bars in its place.
std::string with_meshes(const std::filesystem::path& urdf, const std::string& text,
                        std::string_view folder, AssetTable& assets);

}  // namespace hg::viewer_server
