#include <nlohmann/json.hpp>

#include "apps/offline/identify_command.h"
#include "hg/identify/recorded_elasticity.h"

namespace hg::apps {
namespace {

using identify::IdentifiedJoint;
using identify::RecordedElasticity;

nlohmann::ordered_json beside_files(const identify::Figure& figure, double nominal) {
  return figure_json(figure, "files", nominal);
}

void add_elasticity(const IdentifiedJoint& joint, nlohmann::ordered_json& json) {
  const identify::JointElasticity& found = joint.elasticity;
  json["stiffness_Nm_per_rad"] = beside_files(found.stiffness, joint.nominal.stiffness);
  json["damping_Nms_per_rad"] = beside_files(found.damping, joint.nominal.damping);
  json["torque_Nm"] = found.torque;
  json["twist_rad"] = found.twist;
  json["unexplained_twist_rad"] = found.residual;
}

void add_delay(const identify::DriveDelay& found, double nominal, nlohmann::ordered_json& json) {
  json["delay_s"] = beside_files(found.delay, nominal);
  json["lag_s"] = beside_files(found.lag, 0.0);
  if (!found.lag.is_found) json["lag_s"]["less_than"] = found.lag.deviation;
  json["commanded_rad_per_s"] = found.speed;
  json["unexplained_rad"] = found.residual;
}

}  // namespace

nlohmann::ordered_json identify_joints(const IdentifyRecordingArguments& arguments) {
  const RecordedElasticity result =
      identify::identify_recorded_elasticity(arguments.file, given_device(arguments));
  nlohmann::ordered_json json = recorded_json("joints", result);
  if (result.follows_positions) {
    json["delay_s"] = beside_files(result.delay, result.nominal_delay);
    json["latency_s"] = beside_files(result.latency, result.nominal_latency);
  }
  for (const IdentifiedJoint& identified : result.joints) {
    nlohmann::ordered_json joint = {{"name", identified.name}};
    if (result.has_both_sides) add_elasticity(identified, joint);
    if (result.follows_positions) add_delay(identified.delay, result.nominal_delay, joint);
    std::vector<std::string> missing = identified.elasticity.missing;
    missing.insert(missing.end(), identified.delay.missing.begin(), identified.delay.missing.end());
    joint["missing"] = missing;
    json["joints"].push_back(joint);
  }
  return json;
}

}  // namespace hg::apps
