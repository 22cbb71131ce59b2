/// Drives of a drafted device and of its simulation: typical joints of models/actuators.yaml,
/// scaled to what the URDF says.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/commissioning/generator/scaffold.h"
#include "hg/model/chain_model.h"

namespace hg::generator {

/// What a joint of the manipulator is drafted from; SI units.
struct DrivenJoint {
  model::Joint joint;
  double dq_max = 0.0;  ///< largest speed, rad/s
  double need = 0.0;    ///< torque for weight, acceleration and a person, Nm: without an effort
};

/// Whether these joints have drives in the library: all are revolute.
bool has_typical_drives(const std::vector<DrivenJoint>& joints);

/// Lines "JOINT: {...}" under the key 'actuators' of device.yaml or simulation.yaml, each indented
/// by `indent`.
std::string actuator_lines(const std::vector<DrivenJoint>& joints, const std::string& indent);

/// Text of a simulation.yaml for the device `name`.
std::string simulation_yaml(const std::string& name, const std::vector<DrivenJoint>& joints,
                            Drives drives);

}  // namespace hg::generator
