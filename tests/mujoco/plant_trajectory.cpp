// Trajectories of one joint of the simulated machine on a carriage that yields, as CSV, for
// plant_test.py: the same joint in MuJoCo. Arguments: the effect, the step in s.
//
//   slide (drive, stands) - sway (passive, x) - turn (actuator, z) - link

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "hg/core/error.h"
#include "hg/simulator/plant/plant.h"
#include "hg/simulator/test/plant_setup.h"

namespace {

// plant_test.py has the same numbers
constexpr char kUrdf[] = R"(<robot name='bench'>
  <link name='base'/>
  <joint name='slide' type='prismatic'><parent link='base'/><child link='rail'/><axis xyz='1 0 0'/>
    <limit lower='-1' upper='1' velocity='1' effort='1'/></joint>
  <link name='rail'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0'
    iyz='0'/></inertial></link>
  <joint name='sway' type='prismatic'><parent link='rail'/><child link='carriage'/>
    <axis xyz='1 0 0'/><limit lower='-1' upper='1' velocity='1' effort='1'/></joint>
  <link name='carriage'><inertial><mass value='20'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0'
    iyz='0'/></inertial></link>
  <joint name='turn' type='continuous'><parent link='carriage'/><child link='link'/>
    <axis xyz='0 0 1'/></joint>
  <link name='link'><inertial><origin xyz='0.3 0 0'/><mass value='4'/><inertia ixx='0.1' iyy='0.1'
    izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>
</robot>)";
constexpr double kDuration = 1.0, kInterval = 1e-3;  // s

// Throws SetupError.
void print(const std::string& effect, double step) {
  using namespace hg;
  simulator::PlantConfig config;
  config.step = step;
  config.gantry = {0};
  config.flexible = {{.joint = 1, .stiffness = 2e5, .damping = 100.0}};
  config.manipulator = {2};
  config.current_lag = 0.0;
  config.drive.dead_time = 0.0;
  config.q_p_start = VectorP::Zero(1);
  config.q_m_start = VectorM::Constant(1, 0.7);
  ActuatorModel motor = simulator::bare_actuator(0.5, 3000.0);
  motor.damping = 5.0;
  motor.viscous_friction = 1.0;
  simulator::JointEffects& e = config.effects.emplace_back();
  if (effect == "friction" || effect == "presliding") motor.coulomb_friction = 3.0;
  if (effect == "presliding") e.bristle_stiffness = 5e3, e.bristle_damping = 5.0;
  if (effect == "backlash") e.backlash = 4e-3;
  if (effect == "hysteresis") e.hysteresis = 2.0, e.hysteresis_stiffness = 3e3;
  if (effect == "cogging") e.cogging = 1.5, e.cogging_wave = 60.0;
  config.actuators = {motor};

  const model::ChainModel chain =
      model::ChainModel::from_urdf_text(kUrdf, "bench", {.gravity = false});
  simulator::Plant plant(config, chain, chain.frame("link"));
  simulator::PlantInput input;
  input.brakes_closed = false;
  input.dq_p_command = VectorP::Zero(1);
  input.tau_command = VectorM::Zero(1);
  const int every = static_cast<int>(std::lround(kInterval / step));
  for (int k = 0; k < std::lround(kDuration / step); ++k) {
    if (k % every == 0) {
      std::printf("%.12g,%.12g,%.12g,%.12g\n", k * step, plant.q()[1], plant.truth().q_m[0],
                  plant.truth().theta_m[0]);
    }
    input.tau_command[0] = 12.0 * std::sin(2.0 * std::numbers::pi * 3.0 * k * step);
    plant.step(input);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    print(argv[1], std::strtod(argv[2], nullptr));
  } catch (const hg::SetupError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
