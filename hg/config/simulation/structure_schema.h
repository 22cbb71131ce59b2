/// Description of structure and further joints in simulation.yaml.
#pragma once

#include "hg/config/schema.h"
#include "hg/config/simulation/simulation.h"
#include "hg/config/simulation/simulation_draft.h"

namespace hg::config {

template <class V>
void describe(V& v, StructureDraft& joint) {
  v.number("frequency_Hz", joint.frequency_Hz, kNotNegative,
           "at which all that this joint carries swings, all joints at 0; 0 = rigid");
  v.rule(joint.frequency_Hz == 0.0 || joint.frequency_Hz >= 1.0, "frequency_Hz",
         "must be 0 or at least 1: what is softer sags without end",
         model::to_text(joint.frequency_Hz));
  v.number("damping_ratio", joint.damping_ratio, kShare, "of that oscillation");
  joint.has_axis = v.vector("axis", joint.axis, {.lb = -1e3, .ub = 1e3},
                            "of the yielding, in the link that the joint carries; without it the "
                            "axis of the joint itself");
  v.rule(!joint.has_axis || joint.axis.norm() > 1e-6, "axis", "must have a direction");
}

template <class V>
void describe(V& v, simulator::Waviness& wave) {
  v.number("amplitude_m", wave.amplitude, kNotNegative,
           "of the axis beside where its drive and encoder are; of a revolute axis in rad");
  v.number("period_m", wave.period, kPositive, "of travel, more than 2 pi amplitudes");
  v.rule(wave.period > 2.0 * std::numbers::pi * wave.amplitude, "period_m",
         "must exceed 2 pi amplitudes: the axis never turns back", model::to_text(wave.period));
}

template <class V>
void describe(V& v, FlexibleDraft& joint) {
  v.joint_number({"stiffness_Nm_per_rad", "stiffness_N_per_m"}, joint.unit, joint.stiffness,
                 kNotNegative, "towards position 0; 0 = it moves freely");
  v.joint_number({"damping_Nms_per_rad", "damping_Ns_per_m"}, joint.unit, joint.damping,
                 kNotNegative, "viscous");
}

}  // namespace hg::config
