/// Description of a walk in script.yaml.
#pragma once

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/simulator/person/person.h"

namespace hg::config {

template <class V>
void describe(V& v, person::Doorway& doorway, const std::vector<std::string>& joints) {
  doorway.joint = -1;  // until the name is found
  v.name("hinge", doorway.joint, joints, "a joint of the twin",
         "vertical hinge of a leaf that opens away from the person as its angle grows; z of the "
         "handle stands at right angles on the leaf",
         Need::kRequired);
  v.number("leaf_width_m", doorway.leaf_width, kPositive, "from the hinge axis to its edge");
  v.number("clear_width_m", doorway.clear_width, kPositive,
           "from the hinge axis to the opposite side of the frame");
  v.number("start_s", doorway.start_s, kNotNegative, "when the person sets out");
  v.number("beyond_m", doorway.beyond, kPositive, "where the body stops, behind the shut leaf");
  v.rule(person::has_room(doorway), "clear_width_m", "wide enough for a person");
}

template <class V>
void describe(V& v, person::Walk& walk, const std::vector<std::string>& joints) {
  const bool has_circle =
      v.number("circle_radius_m", walk.circle_radius, kPositive,
               "the hand goes round such a circle, counterclockwise; or checkpoints");
  const bool has_checkpoints = v.list(
      "checkpoints",
      [&](auto& child) {
        person::Checkpoint& checkpoint = walk.checkpoints.emplace_back();
        child.number("x_m", checkpoint.p.x(), kAnyNumber, "of the handle in B", Need::kRequired);
        child.number("y_m", checkpoint.p.y(), kAnyNumber, "of the handle in B", Need::kRequired);
        child.number("heading_rad", checkpoint.heading, kAnyNumber, "of the person",
                     Need::kRequired);
      },
      "the hand goes there in this order; reached nearer than 0.10 m and 15 degrees");
  const bool has_doorway = v.group(
      "doorway", [&](auto& child) { describe(child, walk.doorway, joints); },
      "the body goes through a doorway; the hand opens its leaf as far as the body needs, follows "
      "the arc of the handle, and lets go once the leaf cannot fall onto the body; frame "
      "twin_joints only");
  v.number("speed_m_per_s", walk.speed, kPositive, "of the hand on a circle, else of the body");
  v.number("azimuth_from_heading_rad", walk.azimuth_from_heading, kAnyNumber,
           "azimuth of the handle minus heading of the person who holds it");
  v.number("vertical_bob_m", walk.vertical_bob, kNotNegative,
           "of the hand, 1.8 Hz; from 0.6 m/s on, less when slower");
  v.number("lateral_bob_m", walk.lateral_bob, kNotNegative, "of the hand, 0.9 Hz; likewise");
  v.rule(has_circle + has_checkpoints + has_doorway == 1, "",
         "a walk needs one of circle_radius_m, checkpoints and doorway");
  v.rule(walk.checkpoints.size() <= person::kMaxCheckpoints, "checkpoints",
         "at most 16 checkpoints", std::to_string(walk.checkpoints.size()));
  if (has_circle) walk.kind = person::WalkKind::kCircle;
  if (has_checkpoints) walk.kind = person::WalkKind::kCheckpoints;
  if (has_doorway) walk.kind = person::WalkKind::kDoorway;
  v.rule(!has_circle || person::has_room(walk), "circle_radius_m",
         "so large that the body can walk inside the circle of its hand, at this speed");
}

}  // namespace hg::config
