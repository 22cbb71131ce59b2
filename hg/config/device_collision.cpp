#include "hg/config/device_collision.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "hg/controller/safety/collision/guard.h"
#include "hg/controller/safety/collision/pairs.h"
#include "hg/controller/safety/collision/shapes.h"
#include "hg/model/urdf_parts.h"

namespace hg::config {
namespace {

// index of a link; -1: it is not in the part of the URDF that is used
int link_named(const model::Urdf& urdf, const std::string& name) {
  const auto link = std::ranges::find(urdf.links, name, &model::UrdfLink::name);
  return link == urdf.links.end() ? -1 : static_cast<int>(link - urdf.links.begin());
}

// the link that a joint carries and that the link of this name is fixed to; -1 as above
int carrier_of(const model::Urdf& urdf, const std::string& name) {
  int link = link_named(urdf, name);
  for (std::size_t steps = 0; steps <= urdf.joints.size(); ++steps) {
    const auto above = std::ranges::find(urdf.joints, link, &model::UrdfJoint::child);
    if (above == urdf.joints.end() || above->type != model::UrdfJointType::kFixed) break;
    link = above->parent;
  }
  return link;
}

std::vector<int> carriers_of_capsules(const model::Urdf& urdf, const DeviceDraft& draft) {
  std::vector<int> carriers;
  for (const LinkCapsule& capsule : draft.capsules) {
    carriers.push_back(carrier_of(urdf, name_of(draft.link_names, capsule.link)));
  }
  return carriers;
}

model::UrdfCollision element_of(const LinkCapsule& capsule) {
  const Eigen::Vector3d axis = capsule.to - capsule.from;
  model::UrdfCollision element = {.name = capsule.name,
                                  .T_link_shape = {},
                                  .shape = model::UrdfShape::kCylinder,
                                  .size = {capsule.radius, axis.norm(), 0.0}};
  element.T_link_shape.p = 0.5 * (capsule.from + capsule.to);
  element.T_link_shape.R =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
  return element;
}

// The URDF with the capsules of device.yaml as the only collision elements of their links and of
// the links that are fixed to these.
model::Urdf with_capsules(model::Urdf urdf, const DeviceDraft& draft) {
  const std::vector<int> carriers = carriers_of_capsules(urdf, draft);
  for (model::UrdfLink& link : urdf.links) {
    const bool is_given =
        std::ranges::find(carriers, carrier_of(urdf, link.name)) != carriers.end();
    if (is_given) link.collisions.clear();
  }
  for (const LinkCapsule& capsule : draft.capsules) {
    const int link = link_named(urdf, name_of(draft.link_names, capsule.link));
    if (link >= 0) urdf.links[link].collisions.push_back(element_of(capsule));
  }
  return urdf;
}

// Moves pairs that the file leaves unwatched to the excluded ones.
void leave_out(const DeviceDraft& draft, const model::Urdf& urdf,
               collision::CollisionConfig& collision) {
  const std::vector<std::string>& frames = draft.device.model.chain.frame_names();
  const auto is_named = [&](const UnwatchedPair& named, int shape_a, int shape_b) {
    const collision::Shape &a = collision.shapes[shape_a], &b = collision.shapes[shape_b];
    if (a.is_surrounding || b.is_surrounding) return false;
    if (!named.links.empty()) {
      return carrier_of(urdf, name_of(draft.link_names, named.links[0])) ==
                 carrier_of(urdf, frames[a.frame]) &&
             carrier_of(urdf, name_of(draft.link_names, named.links[1])) ==
                 carrier_of(urdf, frames[b.frame]);
    }
    return draft.capsules[named.capsules[0]].name == a.name &&
           draft.capsules[named.capsules[1]].name == b.name;
  };
  std::erase_if(collision.pairs.watched, [&](const collision::Pair& pair) {
    const bool is_left_out = std::ranges::any_of(draft.unwatched, [&](const UnwatchedPair& named) {
      return is_named(named, pair.a, pair.b) || is_named(named, pair.b, pair.a);
    });
    if (is_left_out) {
      collision.pairs.excluded.push_back({pair.a, pair.b, collision::Exclusion::kGiven, 0.0});
    }
    return is_left_out;
  });
}

}  // namespace

void watch_collisions(const UrdfText& text, DeviceDraft& draft) {
  DeviceConfig& device = draft.device;
  const model::ChainOptions& options = device.chain_options;
  const model::ChainModel& chain = device.model.chain;
  const model::Urdf urdf =
      with_capsules(model::serial_part(model::read_urdf_text(text.text, text.file.generic_string()),
                                       options.root_link, options.tip_link),
                    draft);
  collision::Geometry geometry = collision::read_geometry(urdf, chain);
  device.unknown_links = std::move(geometry.links_without);
  std::erase_if(device.unknown_links, [&](const std::string& link) {
    const std::vector<int> carriers = carriers_of_capsules(urdf, draft);
    return std::ranges::find(carriers, carrier_of(urdf, link)) != carriers.end();
  });
  if (options.tool) device.unknown_links.push_back(options.tool->handle);
  if (geometry.shapes.empty()) return;

  collision::CollisionConfig& collision = device.collision;
  collision.shapes = std::move(geometry.shapes);
  if (device.has_floor) collision.shapes.push_back(collision::floor_at(device.floor_z));
  std::vector<Interval> range = device.model.gantry_range;
  for (const limits::JointLimits& joint : device.model.joint_limits) {
    range.push_back({joint.q_min, joint.q_max});
  }
  collision.pairs = collision::choose_pairs(collision.shapes, chain, range,
                                            collision.safe_distance + collision::kFarEnough);
  leave_out(draft, urdf, collision);
  device.model.keeps_apart = !collision.pairs.watched.empty();
}

}  // namespace hg::config
