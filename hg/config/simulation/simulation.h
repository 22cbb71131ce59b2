/// Sensors of the simulated machine and its differences from the controller's model, from a YAML
/// file: simulation.yaml, described in docs/reference/configuration.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/sources.h"
#include "hg/core/types.h"
#include "hg/model/chain_model.h"
#include "hg/signals/actuator_model.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/payload.h"
#include "hg/simulator/plant/plant_config.h"
#include "hg/simulator/plant/position_loop.h"
#include "hg/simulator/safety_plc.h"
#include "hg/simulator/sensors/sensors.h"

namespace hg::config {

/// True values over those of the device file and its URDF, all > 0.
struct RealityFactors {
  double stiffness = 1.0;      ///< stiffness of the joints
  double damping = 1.0;        ///< damping parallel to the joint stiffness
  double friction = 1.0;       ///< Coulomb, viscous and load-dependent friction
  double rotor_inertia = 1.0;  ///< rotor inertia of the motors
  double mass = 1.0;           ///< mass of all links, with their inertia
  double payload = 1.0;        ///< payload beyond the force/torque sensor
  double latency = 1.0;        ///< latency of the torque loop
  double current_lag = 1.0;    ///< current lag of the motors
  double gantry_lag = 1.0;     ///< lag of the gantry's drives
};

/// Effects of motors beyond a pure torque source. Shares are of the joint's peak torque.
struct MotorEffects {
  double cogging = 0.0;          ///< cogging amplitude, share
  double cogging_per_turn = 24;  ///< cogging periods per turn of the motor
  double ripple = 0.0;           ///< ripple amplitude, share of the present torque
  double ripple_per_turn = 6;    ///< ripple periods per turn of the motor
};

/// Effects of gears beyond a linear spring with Coulomb friction; angles at their output.
struct GearEffects {
  double presliding = 0.0;  ///< displacement until all of the Coulomb friction slips, rad
  double presliding_damping_ratio = 0.0;  ///< damping ratio of the rotor on its bristles
  double presliding_elements = 1.0;       ///< number of elements, 1..kMaxBristles
  double backlash = 0.0;                  ///< backlash from flank to flank, rad
  double hysteresis = 0.0;                ///< friction parallel to the spring, share of peak torque
  double hysteresis_angle = 1e-4;         ///< twist at which the hysteresis slips, rad, > 0
};

/// Joint effects in the form of the plant, for a joint of this actuator.
simulator::JointEffects effects_of(const ActuatorModel& actuator, const MotorEffects& motors,
                                   const GearEffects& gears, double gear_ratio);

/// Actual model where the device file says `nominal`.
ActuatorModel actual(ActuatorModel nominal, const RealityFactors& factors);
TorqueLoop actual(TorqueLoop nominal, const RealityFactors& factors);
DriveModel actual(DriveModel nominal, const RealityFactors& factors);
Payload actual(Payload nominal, const RealityFactors& factors);

/// Drives that follow positions, for a device without actuators of its own.
struct PositionDrives {
  simulator::PositionLoopConfig loop;
  double latency = 0.0;         ///< from a sample to the arrival of its answer at the drives, s
  double current_lag = 0.5e-3;  ///< time constant from the loop's torque to that of the motor, s
  std::vector<ActuatorModel> actuators;  ///< one per manipulator joint; empty = drives are perfect
};

struct SimulationConfig {
  bool is_from_file = false;  ///< false: no simulation file, the device file is exact
  double step_s = 0.25e-3;    ///< largest step of the plant; a period is a whole number of steps
  std::uint64_t seed = 1;
  RealityFactors factors;
  double stop_distance_angle = 0.05;   ///< distance of the end stops beyond the limits, rad
  double stop_distance_length = 0.02;  ///< distance of the end stops of prismatic joints, m
  simulator::EndStopModel end_stop;
  simulator::SensorsConfig sensors;  ///< sensors, seeded with `seed`
  simulator::SafetyPlcConfig safety;
  VectorM gear_ratio;  ///< gear ratio per manipulator joint
  PositionDrives drives;
  MotorEffects motors;
  GearEffects gears;
  std::vector<simulator::Waviness> waviness;  ///< waviness per axis of the gantry; empty = none

  /// A plant with more joints than the controller's model, from `urdf` or with those of
  /// `structure`; without it the chain of the device.
  std::optional<model::ChainModel> chain;
  std::vector<int> gantry, manipulator;  ///< indices of the chain's joints, in the device's order
  std::vector<simulator::FlexibleJoint> flexible;  ///< all other joints of the chain
};

/// The device that a simulation file belongs to. Without joint names, names are not checked.
struct SimulationTarget {
  std::vector<std::string> gantry, manipulator;  ///< joint names
  std::string handle;                            ///< name of the frame H
  model::ChainOptions chain;                     ///< options with which its URDF was read
  std::filesystem::path urdf;
  bool has_actuators = false;  ///< its device.yaml has 'actuators'
};

/// Loads a simulation. Throws SetupError with all faults of the file, one per line.
SimulationConfig load_simulation(const std::filesystem::path& file, SourceReader& reader,
                                 const SimulationTarget& target);

/// A device with its simulation: ideal sensors, and nothing differs, where its file names none.
struct SimulatedDeviceConfig : DeviceConfig {
  SimulationConfig simulation;
};

/// What moves the joints of a simulated device.
enum class PlantKind {
  kIdeal,           ///< drives that follow positions perfectly
  kPositionDrives,  ///< drives that follow positions as motors and gears let them
  kTorqueDrives,    ///< motors that take torques
};
PlantKind plant_of(const SimulatedDeviceConfig& device) noexcept;

/// Loads a device with its simulation. Throws SetupError with all faults of the device's file or
/// else of the simulation's, one per line.
SimulatedDeviceConfig load_simulated_device(const std::filesystem::path& file);
SimulatedDeviceConfig load_simulated_device(const std::filesystem::path& file,
                                            SourceReader& reader);

/// Replaces the device's simulation by that of this file; its texts join those of the device.
/// Throws SetupError as load_simulation() does.
void take_simulation(SimulatedDeviceConfig& device, const std::filesystem::path& file,
                     SourceReader& reader);

}  // namespace hg::config
