#include "hg/scenario/recorded/robot_models.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hg/config/sources.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/model/urdf.h"
#include "hg/model/urdf_parts.h"

namespace hg::scenario {
namespace {

constexpr std::array<std::string_view, 4> kOwnFrames = {"base", "handle", "elbow", "twin_end"};

constexpr const char* kTwinPrefix = "twin/";

// Content of a file of the scenario; empty: it has none of this name.
std::string text_of(const std::vector<config::SourceText>& sources,
                    const std::filesystem::path& file) {
  const auto source = std::ranges::find(sources, file.string(), &config::SourceText::name);
  return source == sources.end() ? std::string() : source->content;
}

/// One chain and where its frames stand in the list of all.
struct Chain {
  model::ChainData data;
  /// Frames of the chain that are published, and their parents; -1 = the base
  std::vector<int> frames, parents;
};

Chain chain_of(const model::ChainModel& model, const std::string& urdf, const std::string& prefix,
               messages::LinkTree& tree) {
  Chain chain{.data = model::ChainData(model), .frames = {}, .parents = {}};
  const std::vector<std::string>& names = model.frame_names();
  const auto is_own = [&](const std::string& name) {
    return prefix.empty() && std::ranges::find(kOwnFrames, name) != kOwnFrames.end();
  };
  std::map<std::string, std::string, std::less<>> parents;
  if (!urdf.empty()) {
    const model::Urdf parsed = model::read_urdf_text(urdf, "URDF");
    for (const model::UrdfJoint& joint : parsed.joints) {
      parents[parsed.links[joint.child].name] = parsed.links[joint.parent].name;
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_own(names[i])) continue;
    const auto parent = parents.find(names[i]);
    const bool has_parent = parent != parents.end() && !is_own(parent->second) &&
                            std::ranges::find(names, parent->second) != names.end();
    chain.frames.push_back(static_cast<int>(i));
    chain.parents.push_back(has_parent ? model.frame(parent->second) : -1);
    tree.frames.push_back({has_parent ? prefix + parent->second : "base", prefix + names[i]});
  }
  return chain;
}

void pass_poses(const Chain& chain, std::vector<Pose>::iterator& next) {
  for (std::size_t i = 0; i < chain.frames.size(); ++i) {
    const Pose& T_B_link = chain.data.pose(chain.frames[i]);
    *next++ =
        chain.parents[i] < 0 ? T_B_link : inverse(chain.data.pose(chain.parents[i])) * T_B_link;
  }
}

}  // namespace

messages::LinkTree link_tree(const config::Scenario& scenario) {
  messages::LinkTree tree;
  const auto device = std::make_shared<Chain>(
      chain_of(scenario.device.model.chain, device_description(scenario), "", tree));
  const auto twin = std::make_shared<Chain>(
      chain_of(scenario.twin.model.chain, text_of(scenario.twin.sources, scenario.twin.urdf),
               kTwinPrefix, tree));
  tree.poses = [device, twin](const Sample& sample, std::vector<Pose>& poses) {
    const RobotState& robot = sample.record.robot;
    const Eigen::VectorXd& q_a = sample.record.twin.q_a;
    const Eigen::VectorXd q = stacked(robot.q_p, robot.q_m);
    // a device that has not given anything yet
    const bool is_known =
        q.size() == device->data.model().nq() && q_a.size() == twin->data.model().nq();
    if (!is_known) return;
    device->data.update_poses(q);
    const TwinBase& base = sample.operator_input.twin_base;
    if (base.is_moving) twin->data.move_base(base.T_B_A, base.twist, base.acceleration);
    twin->data.update_poses(q_a);
    auto next = poses.begin();
    pass_poses(*device, next);
    pass_poses(*twin, next);
  };
  return tree;
}

std::string device_description(const config::Scenario& scenario) {
  return text_of(scenario.device.sources, scenario.device.urdf);
}

std::string twin_description(const config::Scenario& scenario) {
  const std::string text = text_of(scenario.twin.sources, scenario.twin.urdf);
  if (text.empty()) return text;
  return model::with_link_prefix(model::with_mimics(text, scenario.twin.model.chain.couplings()),
                                 kTwinPrefix);
}

}  // namespace hg::scenario
