/// The URDFs of device and twin as parameters of ROS, with meshes that rviz finds.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "live_client.h"

namespace hapticgiant {

/// Fetches each mesh of `urdf` from the program, writes it into `folder` under a name that follows
/// from its content, and calls `done` with the URDF that names these files. A mesh that cannot be
/// had keeps its name and is reported as a warning.
void fetch_meshes(LiveClient& client, const std::string& urdf, const std::filesystem::path& folder,
                  std::function<void(const std::string& urdf)> done);

}  // namespace hapticgiant
