#include "hg/experiments/changes.h"

#include "hg/core/error.h"
#include "hg/model/chain_data.h"

namespace hg::experiments {
namespace {

void require_free_body(const config::Scenario& scenario) {
  const auto& joints = scenario.twin.model.chain.joints();
  if (joints.size() != 1 || joints.front().type != model::JointType::kFloating) {
    throw SetupError("experiment: needs a free body as the twin, got '" + scenario.twin.name + "'");
  }
}

// inertia of the body about its origin, in its own axes
Eigen::MatrixXd inertia_of(const config::Scenario& scenario) {
  model::ChainData chain(scenario.twin.model.chain);
  const VectorA at_rest = VectorA::Zero(chain.model().nv());
  chain.update(scenario.twin.model.q_start, at_rest);
  return chain.M();
}

void set_body(config::Scenario& scenario, const model::FreeBody& body) {
  rendering::TwinModel& model = scenario.twin.model;
  model.chain = model::ChainModel::free_body(
      body,
      {.T_B_root = scenario.twin.T_B_root, .gravity = model.chain.default_loads().gravity > 0});
  model.end_effector = model.chain.frame("handle");
  model.mass_scale = 1.0;
}

}  // namespace

void set_free_twin(config::Scenario& scenario, const FreeTwin& twin) {
  require_free_body(scenario);
  set_body(scenario,
           {.mass = twin.mass, .inertia = inertia_of(scenario).bottomRightCorner<3, 3>()});
  for (std::size_t i = 0; i < 3; ++i) scenario.twin.model.dofs[i].damping = twin.damping;
}

void set_free_inertia(config::Scenario& scenario, double inertia) {
  const double mass = free_twin_of(scenario).mass;
  set_body(scenario, {.mass = mass, .inertia = inertia * Eigen::Matrix3d::Identity()});
}

FreeTwin free_twin_of(const config::Scenario& scenario) {
  require_free_body(scenario);
  const rendering::TwinModel& model = scenario.twin.model;
  return {.mass = model.mass_scale * inertia_of(scenario)(0, 0), .damping = model.dofs[0].damping};
}

void play_script(config::Scenario& scenario, const person::Script& script) {
  const double grasp_s = scenario.script.script.grasp_s;
  scenario.person = person::PersonKind::kScript;
  scenario.script.script = script;
  scenario.script.script.grasp_s = grasp_s;
  scenario.script.start_given = {};
  scenario.duration_s = 0.0;
}

void take_friction(DeviceModel& device) {
  for (ActuatorModel& actuator : device.actuators) {
    actuator.coulomb_friction = actuator.viscous_friction = actuator.load_friction = 0.0;
  }
}

}  // namespace hg::experiments
