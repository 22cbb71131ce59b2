#include "hg/assembly/assembly.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hg/assembly/start_posture.h"

namespace hg::assembly {
namespace {

// channels that the script leaves open begin where the handle is
void fill_in_start(const config::Scenario& scenario, const Start& start, user::Script& script) {
  std::array<double, user::kPoseChannels> pose{};
  switch (script.frame) {
    case user::ScriptFrame::kBase: {
      const config::HandPose hand = config::hand_of(start.T_B_H);
      pose = {hand.p.x(), hand.p.y(), hand.p.z(), hand.azimuth, hand.pitch, hand.roll};
      break;
    }
    case user::ScriptFrame::kCylindrical: {
      const Eigen::Vector3d p = (inverse(scenario.twin.T_B_root) * start.T_B_H).p;
      pose = {std::atan2(p.y(), p.x()), std::hypot(p.x(), p.y()), p.z()};
      break;
    }
    case user::ScriptFrame::kTwinJoints: {
      const ConfigurationA& q = scenario.twin.model.q_start;
      std::copy_n(q.data(), std::min<Eigen::Index>(q.size(), user::kPoseChannels), pose.begin());
      break;
    }
  }
  for (std::size_t i = 0; i < pose.size(); ++i) {
    if (!scenario.script.start_given[i]) script.start[i] = pose[i];
  }
}

}  // namespace

cycle::Cycle make_cycle(const config::Scenario& scenario) {
  const config::Device& device = scenario.device;
  return cycle::Cycle({.estimation = device.estimation,
                       .prepositioning = device.prepositioning,
                       .rendering = device.rendering,
                       .control = device.control,
                       .monitor = device.monitor},
                      device.model, scenario.twin.model);
}

device::SimulatedDevice make_simulated_device(const config::Scenario& scenario) {
  const config::Device& device = scenario.device;
  const Start start = find_start(scenario);
  user::Config person{scenario.person, scenario.script.hand, scenario.script.script};
  if (scenario.person == user::PersonKind::kScript) fill_in_start(scenario, start, person.script);

  const simulation::Config config{.dt = device.rendering.dt,
                                  .drive = device.drive,
                                  .T_H_S = device.T_H_S,
                                  .has_dead_man = device.monitor.has_dead_man,
                                  .q_m_start = start.q_m,
                                  .q_p_start = start.q_p};
  return device::SimulatedDevice(simulation::Simulation(
      config, device.model.chain, device.model.handle,
      user::Person(person, scenario.twin.model.chain, scenario.twin.model.end_effector,
                   scenario.twin.T_B_root)));
}

double planned_duration_s(const config::Scenario& scenario) {
  if (scenario.person != user::PersonKind::kScript) return 0.0;
  const user::Script& script = scenario.script.script;
  return script.grasp_s + (scenario.duration_s > 0.0 ? scenario.duration_s : script.duration_s);
}

}  // namespace hg::assembly
