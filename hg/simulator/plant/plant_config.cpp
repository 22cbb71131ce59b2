#include "hg/simulator/plant/plant_config.h"

#include <cmath>
#include <numbers>
#include <string>

#include "hg/core/error.h"

namespace hg::simulator {
namespace {

void require(bool is_kept, const std::string& item, const std::string& rule, double value) {
  if (!is_kept) throw SetupError(item + ": " + rule + ", got " + std::to_string(value));
}

void require_positive(const std::string& item, double value) {
  require(std::isfinite(value) && value > 0.0, item, "must be positive", value);
}

void require_not_negative(const std::string& item, double value) {
  require(std::isfinite(value) && value >= 0.0, item, "must not be negative", value);
}

void require_size(const std::string& item, Eigen::Index size, Eigen::Index expected) {
  require(size == expected, item, "must have " + std::to_string(expected) + " values",
          static_cast<double>(size));
}

void check_actuator(const ActuatorModel& a, const std::string& joint) {
  require_positive(joint + " rotor_inertia", a.rotor_inertia);
  require_positive(joint + " stiffness", a.stiffness);
  require_not_negative(joint + " damping", a.damping);
  require_not_negative(joint + " coulomb_friction", a.coulomb_friction);
  require_not_negative(joint + " viscous_friction", a.viscous_friction);
  require_not_negative(joint + " load_friction", a.load_friction);
  require(std::isfinite(a.stiction) && a.stiction >= 1.0, joint + " stiction", "must be at least 1",
          a.stiction);
  require_positive(joint + " stribeck_speed", a.stribeck_speed);
  require_positive(joint + " torque_max", a.torque_max);
  require_positive(joint + " speed_full_torque", a.speed_full_torque);
  require(std::isfinite(a.speed_no_load) && a.speed_no_load > a.speed_full_torque,
          joint + " speed_no_load", "must exceed speed_full_torque", a.speed_no_load);
}

void check_effects(const JointEffects& e, const std::string& joint) {
  require_not_negative(joint + " cogging", e.cogging);
  require_not_negative(joint + " cogging_wave", e.cogging_wave);
  require_not_negative(joint + " ripple", e.ripple);
  require_not_negative(joint + " ripple_wave", e.ripple_wave);
  require_not_negative(joint + " bristle_stiffness", e.bristle_stiffness);
  require_not_negative(joint + " bristle_damping", e.bristle_damping);
  require(e.bristles >= 1 && e.bristles <= kMaxBristles, joint + " bristles",
          "must be 1 .. " + std::to_string(kMaxBristles), e.bristles);
  require_not_negative(joint + " backlash", e.backlash);
  require_not_negative(joint + " hysteresis", e.hysteresis);
  if (e.hysteresis > 0.0) require_positive(joint + " hysteresis_stiffness", e.hysteresis_stiffness);
}

void check_waviness(const PlantConfig& config) {
  if (config.waviness.empty()) return;
  require_size("waviness", config.waviness.size(), config.gantry.size());
  for (const Waviness& wave : config.waviness) {
    require_not_negative("waviness amplitude", wave.amplitude);
    require(std::isfinite(wave.period) && wave.period > 2.0 * std::numbers::pi * wave.amplitude,
            "waviness period", "must exceed 2 pi amplitudes", wave.period);
  }
}

// Throws unless every joint of the chain has exactly one role.
void check_joints(const PlantConfig& config, const model::ChainModel& chain) {
  std::vector<int> uses(chain.joints().size(), 0);
  const auto use = [&](int joint) {
    require(joint >= 0 && joint < std::ssize(uses), "joint of the plant",
            "must be an index of the chain's " + std::to_string(uses.size()) + " joints", joint);
    ++uses[joint];
  };
  for (const int joint : config.gantry) use(joint);
  for (const int joint : config.manipulator) use(joint);
  for (const FlexibleJoint& flexible : config.flexible) use(flexible.joint);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const model::Joint& joint = chain.joints()[i];
    require(joint.type != model::JointType::kFloating, "joint " + joint.name,
            "must have one degree of freedom", joint.nv);
    require(uses[i] == 1, "joint " + joint.name,
            "must be one of gantry, manipulator and flexible, once", uses[i]);
  }
  require(config.gantry.size() <= kMaxGantry, "gantry", "at most 2 joints",
          static_cast<double>(config.gantry.size()));
  require(config.manipulator.size() <= kMaxManipulator, "manipulator", "at most 7 joints",
          static_cast<double>(config.manipulator.size()));
  require(config.flexible.size() <= kMaxFlexible, "flexible", "at most 8 joints",
          static_cast<double>(config.flexible.size()));
}

void check_end_stops(const PlantConfig& config, const model::ChainModel& chain) {
  require_positive("end stop stiffness", config.end_stop.stiffness);
  require_not_negative("end stop damping_ratio", config.end_stop.damping_ratio);
  if (!config.gantry_stops.empty()) {
    require_size("gantry_stops", config.gantry_stops.size(), config.gantry.size());
  }
  if (config.end_stops.empty()) return;
  require_size("end_stops", config.end_stops.size(), config.manipulator.size());
  for (std::size_t i = 0; i < config.end_stops.size(); ++i) {
    const double start = config.q_m_start[i];
    const std::string joint = "joint " + chain.joints()[config.manipulator[i]].name;
    require(config.end_stops[i].contains(start), joint, "must start between its end stops", start);
  }
}

}  // namespace

void check_plant_config(const PlantConfig& config, const model::ChainModel& chain) {
  check_joints(config, chain);
  require_positive("step", config.step);
  require_not_negative("current_lag", config.current_lag);
  require_positive("mass", config.mass);
  if (config.position_loop) {
    require_positive("position_Hz", config.position_loop->position_Hz);
    require_positive("speed_Hz", config.position_loop->speed_Hz);
  }
  require_size("actuators", config.actuators.size(), config.manipulator.size());
  require_size("q_p_start", config.q_p_start.size(), config.gantry.size());
  require_size("q_m_start", config.q_m_start.size(), config.manipulator.size());
  require_positive("drive lag", config.drive.lag);
  require_not_negative("drive dead_time", config.drive.dead_time);
  require(config.drive.dead_time <= CommandDelay::kMaxPeriods * config.step, "drive dead_time",
          "must not exceed " + std::to_string(CommandDelay::kMaxPeriods) + " steps of the plant",
          config.drive.dead_time);
  for (std::size_t i = 0; i < config.actuators.size(); ++i) {
    const std::size_t joint = config.manipulator[i];
    check_actuator(config.actuators[i], "joint " + chain.joints()[joint].name);
  }
  if (!config.effects.empty()) {
    require_size("effects", config.effects.size(), config.manipulator.size());
  }
  for (std::size_t i = 0; i < config.effects.size(); ++i) {
    const std::size_t joint = config.manipulator[i];
    check_effects(config.effects[i], "joint " + chain.joints()[joint].name);
  }
  check_waviness(config);
  for (const FlexibleJoint& flexible : config.flexible) {
    const std::string joint = "joint " + chain.joints()[flexible.joint].name;
    require_not_negative(joint + " stiffness", flexible.stiffness);
    require_not_negative(joint + " damping", flexible.damping);
  }
  check_end_stops(config, chain);
}

}  // namespace hg::simulator
