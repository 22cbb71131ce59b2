/// Description of what differs in reality, in simulation.yaml.
#pragma once

#include <numbers>

#include "hg/config/schema.h"
#include "hg/config/simulation/simulation.h"

namespace hg::config {

inline constexpr Range kShareOfOne = {.lb = 0.0, .ub = 1.0};
inline constexpr Range kPeriods = {.lb = 0.0, .ub = 1e4};

template <class V>
void describe(V& v, RealityFactors& factors) {
  v.number("stiffness", factors.stiffness, kFactor, "of the joints");
  v.number("damping", factors.damping, kFactor, "parallel to the stiffness");
  v.number("friction", factors.friction, kFactor, "Coulomb, viscous and load-dependent");
  v.number("rotor_inertia", factors.rotor_inertia, kFactor, "of the motors");
  v.number("mass", factors.mass, kFactor, "of all links, with their inertia");
  v.number(
      "payload", factors.payload, kFactor,
      "mass and inertia of what hangs beyond the force/torque sensor, as that sensor feels it");
  v.number("latency", factors.latency, kFactor, "of the torque loop");
  v.number("current_lag", factors.current_lag, kFactor, "of the motors");
  v.number("gantry_lag", factors.gantry_lag, kFactor, "of the drives of the gantry");
}

template <class V>
void describe_end_stops(V& v, SimulationConfig& simulation) {
  v.number("beyond_rad", simulation.stop_distance_angle, kNotNegative,
           "beyond the limits of revolute joints");
  v.number("beyond_m", simulation.stop_distance_length, kNotNegative,
           "beyond the limits of prismatic joints, the gantry's too");
  v.number("stiffness_Nm_per_rad", simulation.end_stop.stiffness, kPositive,
           "of a prismatic joint in N/m; the manipulator's");
  v.number("damping_ratio", simulation.end_stop.damping_ratio, kShare,
           "with the joint's own inertia; 5 throws back 1 % of the energy");
}

template <class V>
void describe(V& v, simulator::SafetyPlcConfig& safety) {
  v.number("discrepancy_s", safety.discrepancy, kPositive,
           "that the two channels of an input may differ");
  v.number("response_s", safety.response, kNotNegative, "to switches");
  v.number("scanner_response_s", safety.scanner_response, kNotNegative, "to a person in a field");
  v.number("stop_time_s", safety.stop_time, kPositive,
           "that a controlled stop may take before the power goes");
  v.number("safe_speed_m_per_s", safety.safe_speed, kPositive,
           "of handle and gantry while the handle is not held; beyond it the scanner's large "
           "field counts");
  v.number("standstill_m_per_s", safety.standstill, kPositive,
           "of handle and gantry while motion is not permitted");
}

template <class V>
void describe(V& v, MotorEffects& motors) {
  v.number("cogging", motors.cogging, kShareOfOne,
           "amplitude of the torque between magnets and iron, share of the joint's peak torque");
  v.number("cogging_per_turn", motors.cogging_per_turn, kPeriods,
           "its periods per turn of a motor");
  v.number("ripple", motors.ripple, kShareOfOne, "amplitude, share of the torque of the moment");
  v.number("ripple_per_turn", motors.ripple_per_turn, kPeriods, "its periods per turn of a motor");
}

template <class V>
void describe(V& v, GearEffects& gears) {
  v.number("presliding_rad", gears.presliding, kNotNegative,
           "way of the motor, at the output of its gear, until all of its Coulomb friction slips: "
           "before that friction is a spring; 0 = it is rigid");
  v.number("presliding_damping_ratio", gears.presliding_damping_ratio, kShare,
           "of the rotor on that spring");
  v.number("presliding_elements", gears.presliding_elements,
           {.lb = 1.0, .ub = simulator::kMaxBristles},
           "of equal friction that slip one after the other (Maxwell slip), a whole number");
  v.rule(gears.presliding_elements == std::floor(gears.presliding_elements), "presliding_elements",
         "must be a whole number", model::to_text(gears.presliding_elements));
  v.number("backlash_rad", gears.backlash, kNotNegative, "from flank to flank, at the output");
  v.number("hysteresis", gears.hysteresis, kShareOfOne,
           "friction parallel to the spring of the joint, share of its peak torque");
  v.number("hysteresis_rad", gears.hysteresis_angle, kPositive,
           "twist of the spring at which that friction slips");
}

}  // namespace hg::config
