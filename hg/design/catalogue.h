/// Joint sizes that a design may use: actuator, mass, price, transmission ratios.
///
/// Torque, speed, rotor inertia and friction count at the output for a nominal ratio and are
/// converted to others; stiffness and damping belong to the gear. Immutable after reading. SI
/// units; prices in any one currency.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/sources.h"
#include "hg/signals/actuator_model.h"

namespace hg::design {

struct JointSize {
  std::string name;
  std::string source;            ///< Where the values come from
  double mass = 0.0;             ///< Mass of the whole joint, kg
  double price = 0.0;            ///< Price of one joint
  double radius = 0.0;           ///< Radius of the housing, m
  double tube_mass = 0.0;        ///< Mass of the tube that suits this joint, kg/m
  double gear_torque_max = 0.0;  ///< Largest peak torque of the gear, Nm
  double gear_ratio = 1.0;       ///< Ratio that `actuator` counts for
  std::vector<double> ratios;    ///< Ratios that can be had
  ActuatorModel actuator;
};

struct Catalogue {
  std::vector<JointSize> sizes;  ///< From small to large: torques do not fall

  /// Index of a size; throws SetupError with the nearest valid name.
  int size(const std::string& name) const;
};

/// Actuator of a joint of this size with another transmission ratio, which is above zero.
ActuatorModel with_ratio(const JointSize& size, double ratio);

/// Reads a catalogue such as models/design/catalogue.yaml. Throws SetupError with all faults of the
/// file, one per line.
Catalogue load_catalogue(const std::filesystem::path& file, config::SourceReader& reader);

}  // namespace hg::design
