/// Description of the impedance of a hand in script.yaml.
#pragma once

#include "hg/config/schema.h"
#include "hg/simulator/person/person.h"

namespace hg::config {

inline constexpr auto kHandPresets = choices_of<person::HandPreset>();

template <class V>
void describe(V& v, person::HandImpedance& hand) {
  person::HandPreset preset = person::HandPreset::kNormal;
  const bool is_given =
      v.choice("preset", preset, kHandPresets, "values of the keys below that are not given");
  if (is_given) hand = person::hand(preset);
  v.vector(
      "stiffness_N_per_m", hand.stiffness, kNotNegative,
      "of the arm, along fore-aft, left-right and vertical: x, y, z of B, turned by the heading "
      "in frame base");
  v.vector("damping_Ns_per_m", hand.damping, kNotNegative, "of the arm, along the same axes");
  v.vector("mass_kg", hand.mass, kPositive, "effective, of hand and arm, along the same axes");
  v.number("grip_stiffness_N_per_m", hand.grip_stiffness, kPositive,
           "between hand and handle, in series with the arm");
  v.number("grip_damping_Ns_per_m", hand.grip_damping, kNotNegative, "between hand and handle");
  v.vector("angular_stiffness_Nm_per_rad", hand.angular_stiffness, kNotNegative,
           "about x, y, z of H");
  v.vector("angular_damping_Nms_per_rad", hand.angular_damping, kNotNegative, "about x, y, z of H");
  v.number("force_max_N", hand.force_max, kPositive, "the arm pulls no harder");
  v.number("torque_max_Nm", hand.torque_max, kPositive, "the hand turns no harder");
  v.number("press_force_N", hand.press_force, kNotNegative,
           "of a mouse, down at the lever; plus as much as it pulls sideways");
  v.number("tremor_N", hand.tremor_rms, kNotNegative,
           "root mean square of the tremor of 8 to 12 Hz along each axis; 0 = none");
}

}  // namespace hg::config
