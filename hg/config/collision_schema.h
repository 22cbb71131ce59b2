/// Description of the collision model in device.yaml.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hg/config/device_draft.h"
#include "hg/config/schema.h"

namespace hg::config {

template <class V>
void describe(V& v, LinkCapsule& capsule, const std::vector<std::string>& links) {
  v.words("name", capsule.name, "shown where it is the nearest to another shape", Need::kRequired);
  v.name("link", capsule.link, links, "a link of the URDF",
         "it moves with this link; the URDF's shapes of what is fixed to it do not count then",
         Need::kRequired);
  v.vector("from_m", capsule.from, kAnyNumber, "one end of its segment, in the link");
  v.vector("to_m", capsule.to, kAnyNumber, "the other end");
  v.number("radius_m", capsule.radius, kPositive, "around the segment", Need::kRequired);
}

template <class V>
void describe(V& v, UnwatchedPair& pair, const DeviceDraft& d) {
  std::vector<std::string> capsules;
  for (const LinkCapsule& capsule : d.capsules) capsules.push_back(capsule.name);
  v.names("links", pair.links, d.link_names, "a link of the URDF",
          "two links, each with all that is fixed to it");
  v.names("capsules", pair.capsules, capsules, "the name of a capsule", "or two capsules");
  v.rule(v.is_given("links") != v.is_given("capsules"), "", "needs either links or capsules");
  for (const auto& [key, names] : {std::pair("links", &pair.links), {"capsules", &pair.capsules}}) {
    v.rule(names->size() == 2 || !v.is_given(key), key, "must be two",
           std::to_string(names->size()));
  }
}

template <class V>
void describe_collision(V& v, DeviceDraft& d) {
  v.flag("is_watched", d.watches_collisions,
         "stop before the device hits itself, its frame or the floor");
  v.number("safe_distance_m", d.device.collision.safe_distance, kPositive,
           "between any two parts while the device brakes");
  v.list(
      "capsules", [&](auto& child) { describe(child, d.capsules.emplace_back(), d.link_names); },
      "shapes in place of meshes: 'hapticgiant new device' fits them");
  v.list(
      "unwatched", [&](auto& child) { describe(child, d.unwatched.emplace_back(), d); },
      "pairs that are not watched, because they never touch, or leave no room to move");
}

}  // namespace hg::config
