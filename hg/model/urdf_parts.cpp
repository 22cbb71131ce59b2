#include "hg/model/urdf_parts.h"

#include <tinyxml2.h>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hg/core/input_fault.h"
#include "hg/core/nearest_name.h"

namespace hg::model {
namespace {

[[noreturn]] void fail(const Urdf& urdf, const std::string& what) {
  throw InputError(InputFault{.file = urdf.source, .what = what});
}

int find_link(const Urdf& urdf, const std::string& name, const std::string& key) {
  std::vector<std::string> names;
  for (const UrdfLink& link : urdf.links) {
    if (link.name == name) return static_cast<int>(names.size());
    names.push_back(link.name);
  }
  fail(urdf, key + " must be a link of the URDF, got '" + name + "', nearest is '" +
                 nearest_name(name, names) + "'");
}

// index of the joint that carries a link; -1 for the root
int joint_above(const Urdf& urdf, int link) {
  const auto found = std::ranges::find(urdf.joints, link, &UrdfJoint::child);
  return found == urdf.joints.end() ? -1 : static_cast<int>(found - urdf.joints.begin());
}

// indices of the joints from `tip` up to `root` (-1: to the root of the URDF)
std::vector<int> path_between(const Urdf& urdf, int root, int tip) {
  std::vector<int> path;
  int link = tip;
  while (link != root && path.size() <= urdf.joints.size()) {  // more: a loop, refused later
    const int joint = joint_above(urdf, link);
    if (joint < 0) {
      if (root < 0) break;
      fail(urdf, "root_link '" + urdf.links[root].name + "' does not carry tip_link '" +
                     urdf.links[tip].name + "'; a chain goes from the root of the URDF outwards");
    }
    path.push_back(joint);
    link = urdf.joints[joint].parent;
  }
  return path;
}

// subtree of `urdf` below the link `root`
Urdf hanging_on(const Urdf& urdf, int root) {
  std::vector<bool> hangs(urdf.links.size(), false);
  hangs[root] = true;
  for (std::size_t pass = 0; pass < urdf.joints.size(); ++pass) {
    for (const UrdfJoint& joint : urdf.joints) {
      if (hangs[joint.parent]) {
        hangs[joint.child] = true;
      }
    }
  }

  Urdf part = {.name = urdf.name, .source = urdf.source, .links = {}, .joints = {}};
  std::vector<int> index(urdf.links.size(), -1);
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    if (!hangs[i]) continue;
    index[i] = static_cast<int>(part.links.size());
    part.links.push_back(urdf.links[i]);
  }
  for (UrdfJoint joint : urdf.joints) {
    joint.parent = index[joint.parent];
    joint.child = index[joint.child];
    if (joint.parent >= 0 && part.links[joint.child].name != urdf.links[root].name) {
      part.joints.push_back(std::move(joint));
    }
  }
  return part;
}

}  // namespace

Urdf serial_part(const Urdf& urdf, const std::string& root, const std::string& tip) {
  const int root_index = root.empty() ? -1 : find_link(urdf, root, "root_link");
  Urdf part = urdf;
  if (!tip.empty()) {
    const std::vector<int> path = path_between(urdf, root_index, find_link(urdf, tip, "tip_link"));
    const auto is_between = [&](const std::string& joint) {
      return std::ranges::any_of(path, [&](int i) { return urdf.joints[i].name == joint; });
    };
    for (UrdfJoint& joint : part.joints) {
      if (is_between(joint.name)) continue;
      joint.is_branch = joint.mimic && is_between(joint.mimic->joint);
      if (joint.is_branch) continue;
      joint.type = UrdfJointType::kFixed;
      joint.fault.reset();
    }
  }
  return root_index < 0 ? part : hanging_on(part, root_index);
}

std::array<UrdfJoint, 3> planar_parts(const UrdfJoint& planar) {
  constexpr double kCos45 = 0.7071067811865476;
  const Eigen::Vector3d& normal = planar.axis;
  const Eigen::Vector3d nearest =
      std::abs(normal.x()) > kCos45 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d x = (nearest - normal.dot(nearest) * normal).normalized();

  std::array<UrdfJoint, 3> parts = {planar, planar, planar};
  parts[0].name += " x";
  parts[0].type = UrdfJointType::kPrismatic;
  parts[0].axis = x;
  parts[1].name += " y";
  parts[1].type = UrdfJointType::kPrismatic;
  parts[1].axis = normal.cross(x);
  parts[2].name += " turn";
  parts[2].type = UrdfJointType::kContinuous;
  for (std::size_t i = 1; i < parts.size(); ++i) parts[i].T_parent_joint = {};
  return parts;
}

void insert_behind(const std::string& behind, const std::string& name,
                   const std::optional<Eigen::Vector3d>& axis, Urdf& urdf) {
  const auto is_taken = [&](const auto& part) { return part.name == name; };
  const auto found = std::ranges::find(urdf.joints, behind, &UrdfJoint::name);
  const bool is_scalar = found != urdf.joints.end() && (found->type == UrdfJointType::kRevolute ||
                                                        found->type == UrdfJointType::kContinuous ||
                                                        found->type == UrdfJointType::kPrismatic);
  if (!is_scalar) {
    fail(urdf, std::string("a joint that yields must be behind a revolute or prismatic ") +
                   "joint, got '" + behind + "'");
  }
  if (std::ranges::any_of(urdf.links, is_taken) || std::ranges::any_of(urdf.joints, is_taken)) {
    fail(urdf, "the name of a joint that yields is taken, got '" + name + "'");
  }
  constexpr double kMass = 1e-9;  // kg; its inertia is that of 1 mm
  UrdfJoint joint = *found;
  joint.name = name;
  joint.parent = static_cast<int>(urdf.links.size());
  joint.T_parent_joint = {};
  joint.position = {};
  joint.velocity_max = joint.effort_max = kInfinity;
  joint.damping = joint.friction = 0.0;
  joint.mimic.reset();
  if (joint.type == UrdfJointType::kRevolute) joint.type = UrdfJointType::kContinuous;
  if (axis) joint.axis = axis->normalized();
  found->child = joint.parent;
  urdf.links.push_back(
      {.name = name,
       .line = joint.line,
       .inertial = Inertial{.mass = kMass, .inertia = 1e-6 * kMass * Eigen::Matrix3d::Identity()},
       .inertial_fault = {},
       .collisions = {}});
  urdf.joints.push_back(std::move(joint));
}

std::string with_mimics(const std::string& urdf, const std::vector<Coupling>& couplings) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) return urdf;
  for (const Coupling& coupling : couplings) {
    if (coupling.curve) continue;
    tinyxml2::XMLElement* joint = document.RootElement()->FirstChildElement("joint");
    while (joint != nullptr && !joint->Attribute("name", coupling.joint.c_str())) {
      joint = joint->NextSiblingElement("joint");
    }
    if (joint == nullptr) continue;
    tinyxml2::XMLElement* mimic = joint->FirstChildElement("mimic");
    if (mimic == nullptr) mimic = joint->InsertNewChildElement("mimic");
    mimic->SetAttribute("joint", coupling.leader.c_str());
    mimic->SetAttribute("multiplier", coupling.ratio);
    mimic->SetAttribute("offset", coupling.offset);
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::string with_link_prefix(const std::string& urdf, const std::string& prefix) {
  tinyxml2::XMLDocument document;
  const bool is_xml = document.Parse(urdf.data(), urdf.size()) == tinyxml2::XML_SUCCESS;
  if (!is_xml || document.RootElement() == nullptr) return urdf;
  const auto add = [&](tinyxml2::XMLElement* element, const char* attribute) {
    const char* name = element != nullptr ? element->Attribute(attribute) : nullptr;
    if (name != nullptr) element->SetAttribute(attribute, (prefix + name).c_str());
  };
  tinyxml2::XMLElement* element = document.RootElement()->FirstChildElement();
  for (; element != nullptr; element = element->NextSiblingElement()) {
    const std::string_view kind = element->Name();
    if (kind == "link") add(element, "name");
    if (kind == "joint") {
      add(element->FirstChildElement("parent"), "link");
      add(element->FirstChildElement("child"), "link");
    }
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace hg::model
