#include "hg/teleoperation/method.h"

#include <cmath>
#include <string>

#include "hg/core/error.h"
#include "hg/teleoperation/model_mediated.h"
#include "hg/teleoperation/passivity_control.h"
#include "hg/teleoperation/position_force.h"
#include "hg/teleoperation/wave_variables.h"

namespace hg::teleoperation {

void check_method(const MethodConfig& config) {
  const auto positive = [](const char* name, double value) {
    if (std::isfinite(value) && value > 0.0) return;
    throw SetupError(std::string("teleoperation: ") + name + " must be positive, got " +
                     std::to_string(value));
  };
  positive("leader_mass", config.leader_mass);
  positive("coordination", config.coordination);
  positive("impedance", config.impedance);
  positive("correction", config.correction);
  positive("contact_force", config.contact_force);
  positive("touch_force", config.touch_force);
}

std::unique_ptr<LeaderMethod> make_leader_method(const MethodConfig& config, double dt) {
  check_method(config);
  switch (config.kind) {
    case MethodKind::kPositionForce:
      return std::make_unique<PositionForceLeader>();
    case MethodKind::kFourChannel:
      return std::make_unique<FourChannelLeader>(config);
    case MethodKind::kWaveVariables:
      return std::make_unique<WaveLeader>(config, dt);
    case MethodKind::kPassivityControl:
      return std::make_unique<PassivityLeader>(config, dt);
    case MethodKind::kModelMediated:
      return std::make_unique<ModelLeader>(config, dt);
  }
  throw SetupError("teleoperation: unknown method");
}

std::unique_ptr<RemoteMethod> make_remote_method(const MethodConfig& config,
                                                 const MachineImpedance& machine, double dt) {
  check_method(config);
  switch (config.kind) {
    case MethodKind::kPositionForce:
      return std::make_unique<PositionForceRemote>();
    case MethodKind::kFourChannel:
      return std::make_unique<FourChannelRemote>(config, machine);
    case MethodKind::kWaveVariables:
      return std::make_unique<WaveRemote>(config, machine, dt);
    case MethodKind::kPassivityControl:
      return std::make_unique<PassivityRemote>(config, machine, dt);
    case MethodKind::kModelMediated:
      return std::make_unique<ModelRemote>(config, machine, dt);
  }
  throw SetupError("teleoperation: unknown method");
}

}  // namespace hg::teleoperation
