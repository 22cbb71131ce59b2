/// Names in a scenario, for messages and summaries.
#pragma once

#include <string>
#include <vector>

#include "hg/analysis/fault_figures.h"
#include "hg/analysis/summary.h"
#include "hg/config/simulation/scenario.h"

namespace hg::scenario {

/// Names of the gantry's axes, from the base on.
std::vector<std::string> gantry_joints(const config::DeviceConfig& device);

/// Names of the manipulator's joints, from the gantry on.
std::vector<std::string> manipulator_joints(const config::DeviceConfig& device);

/// Units of these joints' positions, rad or m.
std::vector<std::string> gantry_units(const config::DeviceConfig& device);
std::vector<std::string> manipulator_units(const config::DeviceConfig& device);

/// Names of the parts of the device for messages.
analysis::Names part_names(const config::Scenario& scenario);

/// A title without the name of its device at the end: "Drawer" of "Drawer, Franka FR3".
std::string without_device(std::string title, const std::string& device);

/// What a simulation leaves out, "ideal drives, ideal encoders, ideal force/torque sensor"; empty
/// where all of them are as real ones.
std::string idealisation(const config::SimulatedDeviceConfig& device);

/// Summary facts of a run given by its scenario: title, plant, sensors, and
/// the actual law, not the requested one.
analysis::RunFacts facts_of_scenario(const config::Scenario& scenario);

}  // namespace hg::scenario
