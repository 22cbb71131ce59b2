#include "hg/check/capability_map.h"

#include <array>
#include <nlohmann/json.hpp>

#include "hg/core/random.h"
#include "hg/workspace/survey.h"
#include "hg/workspace/workspace.h"

namespace hg::check {

nlohmann::ordered_json capability_map(const config::DeviceConfig& device) {
  constexpr int kPostures = 60'000;
  const Eigen::AlignedBox3d box = workspace::handle_box(device.model);
  nlohmann::ordered_json json = {{"kind", "capability"}, {"device", device.name}};
  for (int axis = 0; axis < 3; ++axis) {
    json["box_m"].push_back(std::array{box.min()[axis], box.max()[axis]});
  }
  json["points"] = nlohmann::ordered_json::array();
  Random random(1);
  for (const auto& [p, force] : workspace::cloud(device, kPostures, false, random).positions) {
    json["points"].push_back(std::array{p.x(), p.y(), p.z(), force});
  }
  return json;
}

}  // namespace hg::check
