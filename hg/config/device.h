/// A device from its YAML file: device.yaml, described in docs/reference/configuration.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/sources.h"
#include "hg/controller/estimation/estimation_config.h"
#include "hg/controller/prepositioning/prepositioning_config.h"
#include "hg/controller/rendering/options.h"
#include "hg/controller/safety/collision/collision_config.h"
#include "hg/controller/safety/compliance/compliance_config.h"
#include "hg/controller/safety/monitor_config.h"
#include "hg/controller/safety/passivity/passivity_config.h"
#include "hg/controller/safety/sanitiser_config.h"
#include "hg/controller/tracking/control_config.h"
#include "hg/model/device_model.h"
#include "hg/signals/start_test_config.h"

namespace hg::config {

struct DeviceConfig {
  std::string name;
  std::filesystem::path urdf;
  std::filesystem::path simulation_file;  ///< file of the device's simulation; empty = none
  double floor_z = 0.0;                   ///< height of the floor in B, m
  bool has_floor = false;  ///< collisions with the floor are watched; false = it is only drawn
  tracking::ControlConfig control;  ///< control, with method kDrives for a device without actuators
  DeviceModel model;
  rendering::RenderingOptions rendering;
  prepositioning::PrepositioningConfig prepositioning;
  estimation::EstimationConfig estimation;
  safety::MonitorConfig monitor;
  safety::SanitiserConfig sanitiser;
  passivity::PassivityConfig passivity;
  compliance::ComplianceConfig compliance;
  StartTestConfig start_test;
  /// Collision model; without shapes collisions are not watched
  collision::CollisionConfig collision;
  std::vector<std::string> unknown_links;  ///< moving links of unknown shape
  model::ChainOptions chain_options;       ///< options with which the chain was read
  std::vector<SourceText> sources;         ///< source texts, the YAML file first
  Places places;                           ///< places of the keys of the YAML file
};

/// Sets what follows from law, bounds and control method: whether the law models the motor
/// torques. For a scenario, see settle_law() in simulation/scenario.h.
void settle_law(DeviceConfig& device);

/// Throws SetupError where the device cannot be controlled at `rate_Hz`.
void check_rate(const DeviceConfig& device, double rate_Hz);

/// Loads a device. Throws SetupError with all faults of the file, one per line.
DeviceConfig load_device(const std::filesystem::path& file);
DeviceConfig load_device(const std::filesystem::path& file, SourceReader& reader);

}  // namespace hg::config
