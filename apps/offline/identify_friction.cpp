#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/offline/identify_command.h"
#include "hg/config/device.h"
#include "hg/config/shipped_files.h"
#include "hg/identify/recorded_friction.h"

namespace hg::apps {
namespace {

nlohmann::ordered_json to_json(const identify::JointFriction& joint) {
  const identify::FrictionEstimate& found = joint.found;
  const ActuatorModel& nominal = joint.nominal;
  const auto beside_file = [](const identify::Figure& figure, double in_file) {
    return figure_json(figure, "device_file", in_file);
  };
  nlohmann::ordered_json json = {
      {"name", joint.name},
      {"coulomb_friction_Nm", beside_file(found.coulomb, nominal.coulomb_friction)},
      {"viscous_friction_Nms_per_rad", beside_file(found.viscous, nominal.viscous_friction)},
      {"load_friction", beside_file(found.load, nominal.load_friction)},
      {"stiction", beside_file(found.stiction, nominal.stiction)},
      {"stribeck_rad_per_s", beside_file(found.stribeck_speed, nominal.stribeck_speed)},
      {"presliding_rad", beside_file(found.presliding, nominal.presliding)},
      {"residual_Nm", found.residual},
      {"forward_s", found.forward_s},
      {"backward_s", found.backward_s},
      {"reversals", found.reversals},
      {"speed_rad_per_s", found.speed},
      {"missing", found.missing}};
  if (found.presliding_elements > 0) json["presliding_elements"] = found.presliding_elements;
  return json;
}

}  // namespace

nlohmann::ordered_json identify_friction(const IdentifyRecordingArguments& arguments) {
  std::optional<config::DeviceConfig> device;
  if (!arguments.device.empty()) {
    device = config::load_device(config::find_device(arguments.device, {}));
  }
  const identify::RecordedFriction result =
      identify::identify_recorded_friction(arguments.file, std::move(device));
  nlohmann::ordered_json json = recorded_json("friction", result);
  for (const identify::JointFriction& joint : result.joints) {
    json["joints"].push_back(to_json(joint));
  }
  return json;
}

}  // namespace hg::apps
