#include "hg/new/gripper.h"

#include <algorithm>
#include <cctype>

namespace hg::new_files {
namespace {

using model::Urdf;
using model::UrdfJoint;

constexpr double kStroke = 0.15;  // m, of a finger that slides

bool moves(const UrdfJoint& joint) { return joint.type != model::UrdfJointType::kFixed; }

bool is_of_gripper(const Urdf& urdf, const UrdfJoint& joint) {
  std::string name = joint.name;
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* word : {"finger", "grip", "jaw", "knuckle"}) {
    if (name.find(word) != std::string::npos) return true;
  }
  if (joint.type == model::UrdfJointType::kPrismatic &&
      joint.position.ub - joint.position.lb < kStroke) {
    return true;
  }
  const auto leader = std::ranges::find_if(urdf.joints, [&](const UrdfJoint& other) {
    return joint.mimic && other.name == joint.mimic->joint;
  });
  return leader != urdf.joints.end() && !leader->mimic && is_of_gripper(urdf, *leader);
}

// all moving joints that the link carries
std::vector<const UrdfJoint*> carried(const Urdf& urdf, int link) {
  std::vector<const UrdfJoint*> found;
  std::vector<int> links = {link};
  for (std::size_t i = 0; i < links.size() && i < urdf.links.size(); ++i) {
    for (const UrdfJoint& joint : urdf.joints) {
      if (joint.parent != links[i]) continue;
      if (moves(joint)) found.push_back(&joint);
      links.push_back(joint.child);
    }
  }
  return found;
}

bool carries(const Urdf& urdf, int link, const UrdfJoint& joint) {
  const std::vector<const UrdfJoint*> all = carried(urdf, link);
  return std::ranges::find(all, &joint) != all.end();
}

}  // namespace

std::optional<Gripper> find_gripper(const Urdf& urdf) {
  const auto is_part = [&](const UrdfJoint* joint) { return is_of_gripper(urdf, *joint); };
  for (const UrdfJoint& arm : urdf.joints) {
    if (!moves(arm) || is_part(&arm)) continue;
    const std::vector<const UrdfJoint*> beyond = carried(urdf, arm.child);
    if (beyond.empty() || !std::ranges::all_of(beyond, is_part)) continue;
    const bool is_one_chain = std::ranges::all_of(urdf.joints, [&](const UrdfJoint& joint) {
      return !moves(joint) || is_part(&joint) || carries(urdf, joint.child, *beyond.front());
    });
    if (!is_one_chain) return {};
    Gripper gripper = {.link = urdf.links[static_cast<std::size_t>(arm.child)].name, .joints = {}};
    for (const UrdfJoint* joint : beyond) gripper.joints.push_back(joint->name);
    return gripper;
  }
  return {};
}

}  // namespace hg::new_files
