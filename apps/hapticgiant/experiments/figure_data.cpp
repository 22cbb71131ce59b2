#include "apps/hapticgiant/experiments/figure_data.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "hg/model/chain_data.h"

namespace hg::apps {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json signal(const std::string& name, const std::string& unit, double lower, double upper) {
  return {{"name", name},
          {"column", name + "_" + unit},
          {"unit", unit},
          {"lower", number_or_null(lower)},
          {"upper", number_or_null(upper)}};
}

void add_device(const rendering::DeviceModel& device, Json& json) {
  for (const char* group : {"manipulator", "virtual", "gantry"}) json[group] = Json::array();
  for (int i = 0; i < device.n_m; ++i) {
    const limits::JointLimits& limits = device.joint_limits[static_cast<std::size_t>(i)];
    const model::Joint& joint = device.chain.joints()[static_cast<std::size_t>(device.n_p + i)];
    json["manipulator"].push_back(
        signal(joint.name, is_angle(joint) ? "rad" : "m", limits.q_min, limits.q_max));
  }
  for (const rendering::VirtualJoint& joint : device.virtual_joints) {
    json["virtual"].push_back(signal(joint.name, "rad", joint.limits.q_min, joint.limits.q_max));
  }
  for (int i = 0; i < device.n_p; ++i) {
    const model::Joint& joint = device.chain.joints()[static_cast<std::size_t>(i)];
    json["gantry"].push_back(
        signal(joint.name, is_angle(joint) ? "rad" : "m", joint.position.lb, joint.position.ub));
  }
  const auto box = rendering::handle_limits(device);
  json["box"] = {{"x", {number_or_null(box[0].q_min), number_or_null(box[0].q_max)}},
                 {"y", {number_or_null(box[1].q_min), number_or_null(box[1].q_max)}}};
  json["has_elbow"] = device.elbow >= 0;
}

void add_twin(const rendering::TwinModel& twin, Json& json) {
  json["twin"] = Json::array();
  for (const rendering::TwinDof& dof : twin.dofs) {
    if (dof.q_index < 0) continue;
    const char* unit = dof.is_angle ? "rad" : "m";
    Json entry = signal(dof.name, unit, dof.limits.q_min, dof.limits.q_max);
    entry["speed_column"] = dof.name + "_" + unit + "_per_s";
    entry["speed_max"] = number_or_null(dof.limits.dq_max);
    entry["torque_column"] = dof.name + (dof.is_angle ? "_Nm" : "_N");
    entry["torque_unit"] = dof.is_angle ? "Nm" : "N";
    json["twin"].push_back(entry);
  }
}

// links of the twin at the time of `mark`, root first, in B; null for a twin that floats
Json pose_at(const rendering::TwinModel& twin, const RunTable& table, const Mark& mark) {
  ConfigurationA q = twin.chain.neutral();
  const RowRange rows = table.between(0.0, mark.time_s);
  if (rows.end >= table.rows()) return nullptr;
  for (const rendering::TwinDof& dof : twin.dofs) {
    if (dof.q_index < 0) return nullptr;
    q[dof.q_index] = table[dof.name + (dof.is_angle ? "_rad" : "_m")][rows.end];
  }
  model::ChainData chain(twin.chain);
  chain.update_poses(q);
  Json points = Json::array();
  for (const std::string& name : chain.model().frame_names()) {
    const Eigen::Vector3d p = chain.pose(chain.model().frame(name)).p;
    points.push_back({p.x(), p.y(), p.z()});
  }
  return {{"label", mark.label}, {"time_s", mark.time_s}, {"points", points}};
}

void add_checkpoints(const config::Scenario& scenario, Json& json) {
  for (const EventRule& rule : scenario.events) {
    for (const Condition& condition : rule.all_of) {
      if (condition.kind != ConditionKind::kHandleAt) continue;
      json["checkpoints"].push_back({{"name", rule.name},
                                     {"x_m", condition.place.x()},
                                     {"y_m", condition.place.y()},
                                     {"azimuth_rad", condition.place.z()}});
    }
  }
}

}  // namespace

Json figure_data(const config::Scenario& scenario, const RunTable& table,
                 const std::vector<Mark>& marks, const std::string& kind, const std::string& note) {
  Json json = {{"title", scenario.title},
               {"description", scenario.description},
               {"kind", kind},
               {"note", note}};
  add_device(scenario.device.model, json);
  add_twin(scenario.twin.model, json);
  json["events"] = Json::array();
  json["poses"] = Json::array();
  for (const Mark& mark : marks) {
    json["events"].push_back({{"label", mark.label}, {"time_s", mark.time_s}, {"what", mark.what}});
    if (Json pose = pose_at(scenario.twin.model, table, mark); !pose.is_null()) {
      json["poses"].push_back(std::move(pose));
    }
  }
  json["locked"] = Json::array();
  for (const LockedPhase& phase : table.locked()) {
    json["locked"].push_back(
        {{"joint", phase.joint}, {"from_s", phase.from_s}, {"to_s", phase.to_s}});
  }
  json["checkpoints"] = Json::array();
  add_checkpoints(scenario, json);
  return json;
}

}  // namespace hg::apps
