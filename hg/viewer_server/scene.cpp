#include "hg/viewer_server/scene.h"

#include <cmath>
#include <string_view>

#include "hg/core/error.h"

namespace hg::viewer_server {
namespace {

void check_chain(const SceneChain& chain, std::string_view item) {
  const std::string name(item);
  if (!chain.urdf.empty() && chain.urdf_text.empty() &&
      !std::filesystem::is_regular_file(chain.urdf)) {
    throw SetupError("viewer: " + name + " URDF must be a file, got " + chain.urdf.string());
  }
  if (!chain.T_B_root.p.allFinite() || !chain.T_B_root.R.allFinite()) {
    throw SetupError("viewer: placement of the " + name + " must be finite");
  }
  for (const SceneJoint& joint : chain.joints) {
    if (joint.name.empty())
      throw SetupError("viewer: every joint of the " + name + " needs a name");
  }
}

}  // namespace

void check_scene(const Scene& scene) {
  check_chain(scene.device, "device");
  check_chain(scene.twin, "twin");
  if (scene.box.isEmpty() || !scene.box.min().allFinite() || !scene.box.max().allFinite()) {
    throw SetupError("viewer: box of the handle must be finite and not empty");
  }
  if (!std::isfinite(scene.rate_hz) || scene.rate_hz <= 0.0) {
    throw SetupError("viewer: rate_hz must be positive, got " + std::to_string(scene.rate_hz));
  }
}

}  // namespace hg::viewer_server
