/// Description of twin.yaml.
#pragma once

#include <string>
#include <vector>

#include "hg/config/follower_schema.h"
#include "hg/config/lock_schema.h"
#include "hg/config/parameter_schema.h"
#include "hg/config/schema.h"
#include "hg/config/twin_draft.h"
#include "hg/config/twin_joint_schema.h"

namespace hg::config {

inline constexpr auto kSurroundings = choices_of<Surroundings>();

template <class V>
void describe_chain(V& v, TwinDraft& d) {
  v.words("name", d.name, "name of the twin", Need::kRequired);
  v.path("urdf", d.urdf,
         "kinematics and inertia, with limits that are the defaults of joints; "
         "together with free_body only what is drawn");
  v.choice("surroundings", d.surroundings, kSurroundings,
           "what the page draws around it, for the eye only: rings on the floor, the wall of "
           "models/twins/door, or a building site");
  d.is_free_body = v.group(
      "free_body",
      [&](auto& child) {
        child.number("mass_kg", d.body.mass, kPositive, "mass");
        child.vector("inertia_kg_m2", d.principal_inertia, kPositive,
                     "moments of inertia about the axes of the handle, at the centre of mass");
        child.vector("centre_of_mass_m", d.body.p_handle_com, kAnyNumber, "in the handle frame");
      },
      "a single rigid body: joint 'root', frame 'handle'");
  v.rule(d.is_free_body || v.is_given("urdf"), "", "a twin needs 'urdf' or 'free_body'");
  v.group(
      "placement", [&](auto& child) { describe(child, d.placement); }, "of the root link in B");
  v.flag(facts_of(Parameter::kGravity).key, d.gravity, facts_of(Parameter::kGravity).help);
  v.flag("floating_root", d.floating_root,
         "whether the root link of the URDF moves freely, by a joint 'root'");
}

}  // namespace hg::config
