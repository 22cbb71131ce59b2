/// Description of the bystander in a scenario.
#pragma once

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/simulator/plant/bystander.h"

namespace hg::config {

/// A bystander whom the arm may hit, before frames have numbers.
struct BystanderDraft {
  std::vector<std::string> parts;   ///< names of body parts
  std::vector<std::string> frames;  ///< frame names of the device
  std::string hit_by;               ///< frame that hits, one of `frames`
  std::optional<simulator::BystanderConfig> bystander;
};

inline BystanderDraft bystander_of(const std::vector<std::string>& frames) {
  BystanderDraft draft = {.frames = frames};
  for (const simulator::BodyPart& part : simulator::kBodyParts) draft.parts.emplace_back(part.name);
  return draft;
}

template <class V>
void describe(V& v, BystanderDraft& d, simulator::BystanderConfig& bystander) {
  int part = 0, frame = 0;
  v.name("body_part", part, d.parts, "a part of the body",
         "what is hit: its stiffness, mass and permissible values are those of ISO/TS 15066",
         Need::kRequired);
  v.name("hit_by", frame, d.frames, "a link of the URDF", "whose origin hits it", Need::kRequired);
  bystander.position = bystander.facing = Eigen::Vector3d::Constant(kNoDefault);
  v.vector("position_m", bystander.position, {.lb = -1e3, .ub = 1e3},
           "of the skin in B; must be given");
  v.vector("facing", bystander.facing, {.lb = -1.0, .ub = 1.0},
           "direction out of the skin in B, must be given; only what comes from there is met");
  v.rule(v.is_given("position_m") && v.is_given("facing"), "",
         "a bystander needs 'position_m' and 'facing'");
  v.flag("is_clamped", bystander.is_clamped,
         "it stands against a wall; otherwise it is pushed away");
  v.rule(!v.is_given("facing") || bystander.facing.norm() > 1e-3, "facing",
         "must not be a zero vector");
  if (d.frames.empty()) return;  // the reference page
  bystander.part = &simulator::kBodyParts[part];
  d.hit_by = d.frames[frame];
}

template <class V>
void describe_bystander(V& v, BystanderDraft& d) {
  v.group(
      "bystander",
      [&](auto& child) {
        d.bystander.emplace();
        describe(child, d, *d.bystander);
      },
      "a person in the way of the arm, whom only a simulated device can hit, "
      "docs/concepts/compliance.md");
}

}  // namespace hg::config
