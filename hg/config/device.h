/// A device from its YAML file: device.yaml, described in docs/reference/configuration.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/simulation.h"
#include "hg/config/sources.h"
#include "hg/controller/estimation/estimation.h"
#include "hg/controller/prepositioning/prepositioning.h"
#include "hg/controller/rendering/device_model.h"
#include "hg/controller/rendering/options.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/controller/safety/compliance/compliance.h"
#include "hg/controller/safety/monitor.h"
#include "hg/controller/safety/passivity/passivity.h"
#include "hg/controller/safety/sanitiser.h"
#include "hg/controller/tracking/joint_control.h"
#include "hg/core/types.h"
#include "hg/signals/drive_model.h"
#include "hg/signals/start_test_config.h"

namespace hg::config {

/// Method that finds a posture for a handle pose at the start.
enum class Kinematics {
  kHapticGiant,  ///< closed form of [HANDBOOK] 2.3: two gantry axes, six joints
  kGeneric,      ///< numerically, for any device
};

struct DeviceConfig {
  std::string name;
  std::filesystem::path urdf;
  double rate_Hz = 1000.0;
  double floor_z = 0.0;    ///< height of the floor in B, m
  bool has_floor = false;  ///< collisions with the floor are watched; false = it is only drawn
  Kinematics kinematics = Kinematics::kGeneric;
  DriveModel drive;
  tracking::ControlConfig control;  ///< control, with method kDrives for a device without actuators
  Pose T_H_S;                       ///< force/torque sensor S in the handle frame H
  rendering::DeviceModel model;
  rendering::RenderingOptions rendering;
  prepositioning::PrepositioningConfig prepositioning;
  estimation::EstimationConfig estimation;
  safety::MonitorConfig monitor;
  safety::SanitiserConfig sanitiser;
  passivity::PassivityConfig passivity;
  compliance::ComplianceConfig compliance;  ///< compliance, without period and joint torques
  StartTestConfig start_test;
  /// Collision model; without shapes collisions are not watched
  collision::CollisionConfig collision;
  std::vector<std::string> unknown_links;  ///< moving links of unknown shape
  SimulationConfig simulation;             ///< simulation of this device; defaults without a file
  SimulatedDevice simulated;               ///< properties that a simulation file has to fit
  std::vector<SourceText> sources;         ///< source texts, the YAML file first
  Places places;                           ///< places of the keys of the YAML file
};

/// Sets the values that follow from law, bounds and control method: whether the law knows the motor
/// torques. For a scenario, see settle_law() in scenario.h.
void settle_law(DeviceConfig& device);

/// Sets the rate and all values that follow from it. Throws SetupError when the drive's dead time
/// would span too many periods.
void set_rate(DeviceConfig& device, double rate_Hz);

/// Replaces the device's simulation by that of this file; its texts join those of the device.
/// Throws SetupError as load_simulation() does.
void take_simulation(DeviceConfig& device, const std::filesystem::path& file, SourceReader& reader);

/// Loads a device. Throws SetupError with all faults of the file, one per line.
DeviceConfig load_device(const std::filesystem::path& file);
DeviceConfig load_device(const std::filesystem::path& file, SourceReader& reader);

}  // namespace hg::config
