/// A candidate of a design: link lengths, joint sizes, transmission ratios, gantry size -> the
/// files of a device.
///
/// The structure is that of the HapticGiant: two gantry axes, six joints. The files are those of a
/// base device with what follows from the variables changed; the base's own variables give the base
/// again. What follows, by rule:
///   link mass  = next joint + fittings + tube per length; centre of mass and radius of gyration
///   keep
///                their share of the length
///   speeds     = the base's share of the speed with full torque
///   ddq_max    = the base's, times (peak torque - gravity) / (mass matrix + rotor) over the base's
///                with the arm stretched, at most twice
///   ddq_max of walls = the base's, at most, times what the joints give at the hand over the base's
///   box        = room less the base's margins; heights that q4 and q4 + q5 allow
///   distance and time of a stop = the base's, times the need from full speed over the base's
/// SI units.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/sources.h"
#include "hg/design/catalogue.h"
#include "hg/model/haptic_giant.h"

namespace hg::design {

inline constexpr int kDesignJoints = 6;

/// The decision variables.
struct DesignVariables {
  model::haptic_giant::Lengths lengths;
  std::array<int, kDesignJoints> size{};   ///< Index of each joint's size in the catalogue
  std::array<int, kDesignJoints> ratio{};  ///< Index of its ratio in the size
  double gantry_x = 4.7, gantry_y = 5.5;   ///< Outer size of the gantry's frame, m
  double mount_height = 2.15;              ///< Height of joint 1 above the floor, m

  bool operator==(const DesignVariables& other) const = default;
};

/// What the design rules take from the base device.
struct DesignBase {
  std::vector<config::SourceText> texts;  ///< Device file, URDF and simulation file
  config::DeviceConfig device;
  DesignVariables variables;  ///< Those of the base itself
};

/// Reads the base device. `sizes` and `ratios`: names and ratios of its joints in the catalogue.
/// Throws SetupError unless the base is a HapticGiant with a simulation.
DesignBase load_base(const std::filesystem::path& device, const Catalogue& catalogue,
                     const std::array<std::string, kDesignJoints>& sizes,
                     const std::array<double, kDesignJoints>& ratios);

/// Prices of what is no joint, in the currency of the catalogue. [A] assumed.
struct StructurePrices {
  double tube_per_m = 900.0;     ///< Of the arm, with its fittings
  double gantry_per_m = 2600.0;  ///< Of rails, belts and frame, per metre of both sides
  double fixed = 30000.0;        ///< Drives, sensors, cabinet: the same for all designs
};

/// Files of a device, names relative to one folder.
struct DeviceFiles {
  std::string device, urdf, simulation;  ///< Texts of device.yaml, device.urdf, simulation.yaml

  /// Writes the three files into an existing folder; throws SetupError where that fails.
  void write(const std::filesystem::path& folder) const;
};

struct DeviceDesign {
  DeviceFiles files;
  config::DeviceConfig device;
  double moving_mass = 0.0;  ///< Arm with hand, kg: what hangs at the flange of the gantry
  double price = 0.0;
};

/// Builds the device of these variables. Throws SetupError where they make no device: a link too
/// short for its joints, a gantry smaller than its margins. Without `watches_collisions` the device
/// is for judging only: choosing the pairs to watch takes four fifths of the time.
DeviceDesign make_device(const DesignBase& base, const Catalogue& catalogue,
                         const DesignVariables& variables, const std::string& name,
                         const StructurePrices& prices = {}, bool watches_collisions = true);

}  // namespace hg::design
