/// Composition of a simulated machine: set-up data of Plant.
///
/// SI units; for a prismatic joint read N for Nm and m for rad.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/model/chain_model.h"
#include "hg/signals/actuator_model.h"
#include "hg/signals/drive_model.h"
#include "hg/simulator/plant/bystander.h"
#include "hg/simulator/plant/friction.h"
#include "hg/simulator/plant/position_loop.h"

namespace hg::simulator {

inline constexpr int kMaxFlexible = 8;  ///< maximum number of flexible joints
inline constexpr int kMaxLinks = kMaxManipulator + kMaxFlexible;
using VectorL = VectorUpTo<kMaxLinks>;  ///< joints moved by forces: manipulator, then flexible
using MatrixL = MatrixUpTo<kMaxLinks, kMaxLinks>;
using VectorQ = VectorUpTo<kMaxGantry + kMaxLinks>;  ///< all joints, in the order of the chain

/// Undriven joint: the bending of a link, of the trolley or of the gantry's frame.
struct FlexibleJoint {
  int joint = 0;           ///< joint index in the chain
  double stiffness = 0.0;  ///< spring towards position 0, Nm/rad, >= 0; 0 = it moves freely
  double damping = 0.0;    ///< Nms/rad, >= 0
};

/// Effects of motor and gear of a joint beyond its ActuatorModel; 0 = off. Angles and torques at
/// the output of the gear, as everywhere in the plant. Equations: docs/concepts/simulator.md.
struct JointEffects {
  double cogging = 0.0;            ///< amplitude, Nm, >= 0; acts without current, too
  double cogging_wave = 0.0;       ///< periods of cogging per 2 pi of theta, >= 0
  double ripple = 0.0;             ///< amplitude, share of the motor's torque, >= 0
  double ripple_wave = 0.0;        ///< periods of ripple per 2 pi of theta, >= 0
  double bristle_stiffness = 0.0;  ///< presliding stiffness, Nm/rad, >= 0; 0 = friction is rigid
  double bristle_damping = 0.0;    ///< damping of all bristles together, Nms/rad, >= 0
  int bristles = 1;                ///< number, 1..kMaxBristles; the k-th has bristle_stiffness / k
  double backlash = 0.0;           ///< play from flank to flank, rad, >= 0
  double hysteresis = 0.0;         ///< friction parallel to the spring, Nm, >= 0
  /// Stiffness in series with it, Nm/rad, > 0 unless hysteresis is 0
  double hysteresis_stiffness = 0.0;
};

/// Deviation of a gantry axis caused by belt, wheels and rail: q = d + amplitude sin(2 pi d /
/// period + phase), where d is the position known to its drive and encoder.
struct Waviness {
  double amplitude = 0.0;  ///< m, >= 0; 0 = none
  double period = 1.0;     ///< m of travel, > 2 pi amplitude: the axis never turns back
};

/// Buffers at the ends of travel: they push and never pull.
struct EndStopModel {
  double stiffness = 1e5;  ///< Nm/rad, > 0; rubber on steel, assumed
  /// Damping ratio with the joint's own inertia, >= 0; 5 throws back 1 %
  double damping_ratio = 5.0;
};

/// Set-up data of a plant. Indices are those of ChainModel::joints(); every joint is in exactly one
/// list.
struct PlantConfig {
  double step = 0.25e-3;         ///< s, > 0; damps 15 Hz by 1.2 % of critical, [HANDBOOK] 4.4
  std::vector<int> gantry;       ///< joints whose motion the drives prescribe
  std::vector<int> manipulator;  ///< joints with actuators
  std::vector<FlexibleJoint> flexible;
  std::vector<ActuatorModel> actuators;  ///< one per manipulator joint
  double current_lag = 0.5e-3;  ///< time constant from torque command to torque, s, >= 0; [C] 0
  double mass = 1.0;            ///< factor on all masses of the chain, > 0
  DriveModel drive;             ///< dynamics of every gantry axis
  /// Present: the actuators follow positions and have this controller; empty: they take torques
  std::optional<PositionLoopConfig> position_loop;
  std::vector<Interval> gantry_stops;  ///< buffers at the ends of the gantry; empty = none
  std::vector<Interval> end_stops;     ///< end stops of the manipulator's links; empty = none
  EndStopModel end_stop;
  std::vector<JointEffects> effects;  ///< one per manipulator joint; empty = none
  std::vector<Waviness> waviness;     ///< one per axis of the gantry; empty = none
  std::uint64_t seed = 1;             ///< seed of the phases of cogging, ripple and waviness
  VectorP q_p_start;
  VectorM q_m_start;
  /// Bystander in the arm's way, none if empty; its frame is in the chain
  std::optional<BystanderConfig> bystander;
};

/// Throws SetupError, `item: rule, got value`, unless a plant can be built from it.
void check_plant_config(const PlantConfig& config, const model::ChainModel& chain);

}  // namespace hg::simulator
