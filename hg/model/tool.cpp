#include "hg/model/tool.h"

#include <algorithm>
#include <vector>

#include "hg/core/input_fault.h"
#include "hg/core/nearest_name.h"

namespace hg::model {
namespace {

int find(const Urdf& urdf, const std::string& link) {
  const auto found = std::ranges::find(urdf.links, link, &UrdfLink::name);
  return found == urdf.links.end() ? -1 : static_cast<int>(found - urdf.links.begin());
}

[[noreturn]] void fail(const Urdf& urdf, const std::string& what) {
  throw InputError(InputFault{.file = urdf.source, .item = "tool", .what = what});
}

}  // namespace

void attach(const Tool& tool, Urdf& urdf) {
  const int flange = find(urdf, tool.link);
  if (flange < 0) {
    std::vector<std::string> names;
    for (const UrdfLink& link : urdf.links) names.push_back(link.name);
    fail(urdf, "the flange must be a link of the chain, got '" + tool.link + "', nearest is '" +
                   nearest_name(tool.link, names) + "'");
  }
  if (find(urdf, tool.handle) >= 0) {
    fail(urdf, "the URDF has a link '" + tool.handle +
                   "' already: take that as the handle instead of a tool, or rename it");
  }

  // mass in the axes of the handle, which is a link of its own
  UrdfLink link = {.name = tool.handle, .line = urdf.links[flange].line};
  if (tool.mass > 0.0) {
    const Pose T_handle_link = inverse(tool.T_link_handle);
    const Inertial inertial = {tool.mass, T_handle_link.p + T_handle_link.R * tool.p_com,
                               T_handle_link.R * tool.inertia * T_handle_link.R.transpose()};
    check_inertial(inertial, "tool");
    link.inertial = inertial;
  }
  urdf.links.push_back(link);
  urdf.joints.push_back({.name = tool.handle + "_fixed",
                         .line = link.line,
                         .type = UrdfJointType::kFixed,
                         .parent = flange,
                         .child = static_cast<int>(urdf.links.size()) - 1,
                         .T_parent_joint = tool.T_link_handle});
}

}  // namespace hg::model
