/// How the simulated machine differs from what the controller is told, and its sensors, from a YAML
/// file: simulation.yaml, described in docs/configuration.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/sources.h"
#include "hg/core/types.h"
#include "hg/model/chain.h"
#include "hg/signals/actuator_model.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/payload.h"
#include "hg/simulation/plant_config.h"
#include "hg/simulation/safety_plc.h"
#include "hg/simulation/sensors.h"

namespace hg::config {

/// True values over those of the device file and its URDF, all > 0.
struct RealityFactors {
  double stiffness = 1.0;      ///< of the joints
  double damping = 1.0;        ///< parallel to it
  double friction = 1.0;       ///< Coulomb, viscous and load-dependent
  double rotor_inertia = 1.0;  ///< of the motors
  double mass = 1.0;           ///< of all links, with their inertia
  double payload = 1.0;        ///< of what hangs beyond the force/torque sensor
  double latency = 1.0;        ///< of the torque loop
  double current_lag = 1.0;    ///< of the motors
  double gantry_lag = 1.0;     ///< of its drives
};

/// What motors do that a pure torque source does not. Shares are of the joint's peak torque.
struct MotorEffects {
  double cogging = 0.0;          ///< amplitude, share
  double cogging_per_turn = 24;  ///< periods per turn of the motor
  double ripple = 0.0;           ///< amplitude, share of the torque of the moment
  double ripple_per_turn = 6;    ///< periods per turn of the motor
};

/// What gears do that a linear spring with Coulomb friction does not; angles at their output.
struct GearEffects {
  double presliding = 0.0;                ///< way until all of the Coulomb friction slips, rad
  double presliding_damping_ratio = 0.0;  ///< of the rotor on its bristles
  double presliding_elements = 1.0;       ///< 1..kMaxBristles
  double backlash = 0.0;                  ///< from flank to flank, rad
  double hysteresis = 0.0;                ///< friction parallel to the spring, share of peak torque
  double hysteresis_angle = 1e-4;         ///< twist at which it slips, rad, > 0
};

/// As the plant takes them, for a joint of this actuator.
simulation::JointEffects effects_of(const ActuatorModel& actuator, const MotorEffects& motors,
                                    const GearEffects& gears, double gear_ratio);

/// What is really the case where the device file says `told`.
ActuatorModel actual(ActuatorModel told, const RealityFactors& factors);
TorqueLoop actual(TorqueLoop told, const RealityFactors& factors);
DriveModel actual(DriveModel told, const RealityFactors& factors);
Payload actual(Payload told, const RealityFactors& factors);

struct Simulation {
  bool is_from_file = false;  ///< false: there is none, all is as the device file says
  double step_s = 0.25e-3;    ///< largest step of the plant; a period is a whole number of steps
  std::uint64_t seed = 1;
  RealityFactors factors;
  double stop_distance_angle = 0.05;   ///< of the end stops beyond the limits, rad
  double stop_distance_length = 0.02;  ///< the same of prismatic joints, m
  simulation::EndStopModel end_stop;
  simulation::SensorsConfig sensors;  ///< with `seed`
  simulation::SafetyPlcConfig safety;
  VectorM gear_ratio;  ///< of the manipulator joints
  MotorEffects motors;
  GearEffects gears;
  std::vector<simulation::Waviness> waviness;  ///< per axis of the gantry; empty = none

  /// A plant with more joints than the controller's model, from `urdf` or with those of
  /// `structure`; without it the chain of the device.
  std::optional<model::Chain> chain;
  std::vector<int> gantry, manipulator;  ///< indices of its joints, in the device's order
  std::vector<simulation::FlexibleJoint> flexible;  ///< all its other joints
};

/// The device that a simulation file belongs to. Without names of joints they are not checked.
struct SimulatedDevice {
  std::vector<std::string> gantry, manipulator;  ///< names of its joints
  std::string handle;                            ///< name of its frame H
  model::ChainOptions chain;                     ///< with which its URDF was read
  std::filesystem::path urdf;
};

/// Throws SetupError with all faults of the file, one per line.
Simulation load_simulation(const std::filesystem::path& file, SourceReader& reader,
                           const SimulatedDevice& device);

}  // namespace hg::config
