/// Drives of a drafted device and of its simulation: typical joints of models/actuators.yaml,
/// scaled to what the URDF says.
#pragma once

#include <string>
#include <vector>

#include "hg/config/actuator_library.h"
#include "hg/model/chain_model.h"
#include "hg/new/scaffold.h"

namespace hg::new_files {

/// A joint of the manipulator with the type of the library that is scaled to it.
struct DrivenJoint {
  model::Joint joint;
  config::ActuatorType type;
};

/// Lines "JOINT: {...}" under the key 'actuators' of device.yaml or simulation.yaml, each indented
/// by `indent`.
std::string actuator_lines(const std::vector<DrivenJoint>& joints, const std::string& indent);

/// Text of a simulation.yaml for the device `name`.
std::string simulation_yaml(const std::string& name, const std::vector<DrivenJoint>& joints,
                            Drives drives);

}  // namespace hg::new_files
