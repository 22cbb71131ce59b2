/// What a simulated machine is made of: set-up data of Plant.
///
/// SI units; for a prismatic joint read N for Nm and m for rad.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/model/chain.h"
#include "hg/signals/actuator_model.h"
#include "hg/signals/drive_model.h"
#include "hg/simulation/bystander.h"
#include "hg/simulation/friction.h"

namespace hg::simulation {

inline constexpr int kMaxFlexible = 8;  ///< flexible joints
inline constexpr int kMaxLinks = kMaxManipulator + kMaxFlexible;
using VectorL = VectorUpTo<kMaxLinks>;  ///< joints that the forces move: manipulator, then flexible
using MatrixL = MatrixUpTo<kMaxLinks, kMaxLinks>;
using VectorQ = VectorUpTo<kMaxGantry + kMaxLinks>;  ///< all joints, in the order of the chain

/// A joint that nobody drives: the bending of a link, of the trolley or of the gantry's frame.
struct FlexibleJoint {
  int joint = 0;           ///< its index in the chain
  double stiffness = 0.0;  ///< Nm/rad towards position 0, >= 0; 0 = it moves freely
  double damping = 0.0;    ///< Nms/rad, >= 0
};

/// What motor and gear of a joint do beyond their ActuatorModel; 0 = not. Angles and torques at the
/// output of the gear like everything of the plant. docs/simulator.md says with which equations.
struct JointEffects {
  double cogging = 0.0;               ///< amplitude, Nm, >= 0; without current, too
  double cogging_wave = 0.0;          ///< its periods over 2 pi of theta, >= 0
  double ripple = 0.0;                ///< amplitude, share of the motor's torque, >= 0
  double ripple_wave = 0.0;           ///< as cogging_wave
  double bristle_stiffness = 0.0;     ///< of presliding, Nm/rad, >= 0; 0 = friction is rigid
  double bristle_damping = 0.0;       ///< of all bristles together, Nms/rad, >= 0
  int bristles = 1;                   ///< 1..kMaxBristles; the k-th has bristle_stiffness / k
  double backlash = 0.0;              ///< way from flank to flank, rad, >= 0
  double hysteresis = 0.0;            ///< friction parallel to the spring, Nm, >= 0
  double hysteresis_stiffness = 0.0;  ///< in series with it, Nm/rad, > 0 unless hysteresis is 0
};

/// Belt, wheels and rail lead an axis of the gantry astray: q = d + amplitude sin(2 pi d / period +
/// phase), d being what its drive and its encoder know.
struct Waviness {
  double amplitude = 0.0;  ///< m, >= 0; 0 = none
  double period = 1.0;     ///< m of travel, > 2 pi amplitude: the axis never turns back
};

/// Buffers at the ends of travel: they push and never pull.
struct EndStopModel {
  double stiffness = 1e5;      ///< Nm/rad, > 0; rubber on steel, assumed
  double damping_ratio = 5.0;  ///< of the joint's own inertia on it, >= 0; 5 throws back 1 %
};

/// Set-up data. Indices are those of Chain::joints(); every joint is in exactly one list.
struct PlantConfig {
  double step = 0.25e-3;         ///< s, > 0; damps 15 Hz by 1.2 % of critical, [HANDBOOK] 4.4
  std::vector<int> gantry;       ///< joints that the drives prescribe
  std::vector<int> manipulator;  ///< joints with actuators
  std::vector<FlexibleJoint> flexible;
  std::vector<ActuatorModel> actuators;  ///< one per manipulator joint
  double current_lag = 0.5e-3;           ///< from torque command to torque, s, >= 0; [C] 0
  double mass = 1.0;                     ///< all masses of the chain times this, > 0
  DriveModel drive;                      ///< of every gantry axis
  std::vector<Interval> gantry_stops;    ///< buffers at the ends of the gantry; empty = none
  std::vector<Interval> end_stops;       ///< of the links of the manipulator; empty = none
  EndStopModel end_stop;
  std::vector<JointEffects> effects;  ///< one per manipulator joint; empty = none
  std::vector<Waviness> waviness;     ///< one per axis of the gantry; empty = none
  std::uint64_t seed = 1;             ///< of the phases of cogging, ripple and waviness
  VectorP q_p_start;
  VectorM q_m_start;
  std::optional<BystanderConfig> bystander;  ///< whom the arm may hit; its frame is of the chain
};

/// Throws SetupError, `item: rule, got value`, unless a plant can be made of it.
void check(const PlantConfig& config, const model::Chain& chain);

}  // namespace hg::simulation
