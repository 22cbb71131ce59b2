#include "apps/offline/run_data.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/hapticgiant/output_file.h"
#include "hg/core/enumerators.h"
#include "hg/core/index.h"
#include "hg/model/chain_data.h"

namespace hg::apps {
namespace {

using Json = nlohmann::ordered_json;

Json quantity(const std::string& name, bool is_angle, double lower, double upper) {
  return {{"name", name}, {"unit", is_angle ? "rad" : "m"}, {"lower", lower}, {"upper", upper}};
}

void add_device(const DeviceModel& device, Json& json) {
  for (const char* group : {"manipulator", "virtual", "gantry"}) json[group] = Json::array();
  for (int i = 0; i < device.n_m; ++i) {
    const limits::JointLimits& limits = device.joint_limits[i];
    const model::Joint& joint = device.chain.joints()[device.n_p + i];
    json["manipulator"].push_back(
        quantity(joint.name, !joint.is_slide(), limits.q_min, limits.q_max));
  }
  for (const VirtualJoint& joint : device.virtual_joints) {
    json["virtual"].push_back(quantity(joint.name, true, joint.limits.q_min, joint.limits.q_max));
    json["virtual"].back()["weights"] =
        std::vector<double>(joint.weights.begin(), joint.weights.end());
  }
  for (int i = 0; i < device.n_p; ++i) {
    const model::Joint& joint = device.chain.joints()[i];
    json["gantry"].push_back(
        quantity(joint.name, !joint.is_slide(), joint.position.lb, joint.position.ub));
  }
  const auto box = handle_limits(device);
  json["box"] = {{"x", {box[0].q_min, box[0].q_max}}, {"y", {box[1].q_min, box[1].q_max}}};
  json["has_elbow"] = device.elbow >= 0;
}

void add_twin(const rendering::TwinModel& twin, Json& json) {
  json["twin"] = Json::array();
  for (std::size_t i = 0; i < twin.dofs.size(); ++i) {
    const rendering::TwinDof& dof = twin.dofs[i];
    if (dof.q_index < 0) continue;
    Json entry = quantity(dof.name, dof.is_angle, dof.limits.q_min, dof.limits.q_max);
    entry["speed_max"] = dof.limits.dq_max;
    entry["q"] = dof.q_index;
    entry["v"] = i;
    json["twin"].push_back(entry);
  }
}

// Limit, joint, coordinate or surface that a condition is about, and whether that is an angle;
// empty: none.
std::pair<std::string, bool> subject(const Condition& condition, const config::Scenario& scenario) {
  const std::size_t i = condition.index;
  const DeviceModel& device = scenario.device.model;
  switch (condition.kind) {
    case ConditionKind::kLimit:
    case ConditionKind::kSpeedLimit:
    case ConditionKind::kLocked:
      return {scenario.limits[i].name, scenario.limits[i].is_angle};
    case ConditionKind::kTwinAbove:
    case ConditionKind::kTwinBelow:
      for (const rendering::TwinDof& dof : scenario.twin.model.dofs) {
        if (dof.q_index == condition.index) return {dof.name, dof.is_angle};
      }
      return {fmt::format("coordinate {} of the twin", condition.index), true};
    case ConditionKind::kTurns:
      return {device.manipulator_joint(condition.index), true};
    case ConditionKind::kGantryAbove:
    case ConditionKind::kGantryBelow:
      return {device.chain.joints()[i].name, false};
    case ConditionKind::kSurface:
      return {scenario.surfaces[i].name, false};
    default:
      return {};
  }
}

Json describe(const Condition& condition, const config::Scenario& scenario) {
  const auto kinds = enumerators<ConditionKind>();
  const auto [name, is_angle] = subject(condition, scenario);
  Json json = {{"kind", words_of(kinds[index(condition.kind)].name)}, {"value", condition.value}};
  if (!name.empty()) json["of"] = name;
  if (!name.empty()) json["unit"] = is_angle ? "rad" : "m";
  if (condition.side != LimitState::kInactive) json["side"] = to_string(condition.side);
  if (condition.kind == ConditionKind::kHandleAt) {
    json["place"] = {condition.place.x(), condition.place.y(), condition.place.z()};
  }
  return json;
}

}  // namespace

std::vector<std::string> signal_names() {
  return {"time_s",    "cycle",     "mode",       "state_hash",    "felt_limit", "sync_error",
          "robot.w_h", "robot.q_p", "robot.dq_p", "reference.q_m", "handle.p",   "reference.dq_m",
          "handle.r",  "p_b_elbow", "twin.q_a",   "twin.dq_a",     "tau_a",      "limits.cause"};
}

Json describe(const config::Scenario& scenario) {
  Json json = {{"title", scenario.title},
               {"description", scenario.description},
               {"device", scenario.device.name},
               {"rate_Hz", scenario.device.model.rate_Hz},
               {"grasp_s", scenario.script.script.grasp_s},
               {"running_mode", static_cast<int>(Mode::kRunning)},
               {"lock_cause", static_cast<int>(LimitCause::kLock)}};
  add_device(scenario.device.model, json);
  add_twin(scenario.twin.model, json);
  for (const LimitInfo& limit : scenario.limits) {
    json["limits"].push_back(quantity(limit.name, limit.is_angle, limit.range.lb, limit.range.ub));
  }
  return json;
}

Json describe(const EventRule& rule, const config::Scenario& scenario) {
  Json json = {{"name", rule.name}, {"what", rule.what}, {"all_of", Json::array()}};
  for (const Condition& condition : rule.all_of) {
    json["all_of"].push_back(describe(condition, scenario));
  }
  return json;
}

Json twin_points(const config::Scenario& scenario, const ConfigurationA& q_a) {
  const rendering::TwinModel& twin = scenario.twin.model;
  for (const rendering::TwinDof& dof : twin.dofs) {
    if (dof.q_index < 0) return nullptr;
  }
  model::ChainData chain(twin.chain);
  chain.update_poses(q_a);
  Json points = Json::array();
  for (const std::string& name : chain.model().frame_names()) {
    const Eigen::Vector3d p = chain.pose(chain.model().frame(name)).p;
    points.push_back({p.x(), p.y(), p.z()});
  }
  return points;
}

void write_run(const std::filesystem::path& folder, const Json& run,
               const recording::Columns& columns) {
  write_output((folder / "signals.npy").string(), recording::to_npy(columns));
  // a recording may hold texts that are no UTF-8
  write_output((folder / "run.json").string(),
               run.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace hg::apps
