#include "hg/controller/tracking/loop_stability.h"

#include <compare>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "hg/controller/tracking/sampled_arm.h"
#include "hg/core/linear_algebra.h"
#include "hg/model/chain_data.h"

namespace hg::tracking {
namespace {

// Where the parts of the sampled loop stand in its state.
struct Layout {
  int n, slots;
  // theta, theta', q, q', current; LinearObservers; commands under way, the oldest first
  int observers() const { return 5 * n; }
  int size() const { return (9 + slots) * n; }
};

// Torques that the controller answers with to unit errors of theta, theta', q, q' and tau_J.
// `weight` holds the links in posture `q`.
Eigen::MatrixXd feedback(const Loop& loop, const Eigen::VectorXd& q, const VectorM& weight,
                         double latency) {
  constexpr double kError = 1e-7;  // small against every limit of the controller
  const int n = loop.device.n_m;
  JointControl control(loop.config, loop.device);
  const RobotState robot = standing(loop.device.actuators, q, weight);
  const ReferenceState reference = standing_reference(robot);
  ControlState at_start = control.start();
  at_start.latency = latency / loop.device.dt();
  control.begin(reference, robot, at_start);
  const auto torque = [&](const RobotState& seen) -> Eigen::VectorXd {
    ControlState state = at_start;
    CommandFrame command;
    TrackingReport report;
    control.step(reference, reference, seen, state, command, report);
    return command.tau_m;
  };
  const Eigen::VectorXd undisturbed = torque(robot);
  Eigen::MatrixXd answers(n, 5 * n);
  int column = 0;
  for (VectorM RobotState::*part : {&RobotState::theta_m, &RobotState::dtheta_m, &RobotState::q_m,
                                    &RobotState::dq_m, &RobotState::tau_m}) {
    for (int i = 0; i < n; ++i) {
      RobotState disturbed = robot;
      (disturbed.*part)[i] += kError;
      answers.col(column++) = (torque(disturbed) - undisturbed) / kError;
    }
  }
  return answers;
}

// The arm in one posture.
struct Arm {
  Eigen::VectorXd q;
  VectorM weight;        // of the links, as the controller knows it
  Eigen::MatrixXd step;  // of the plant: e^(A dt / kPlantSteps), see plant_with_input()
};

Arm arm_at(const Eigen::VectorXd& q, const Loop& loop, const TruePlant& plant) {
  const int n = loop.device.n_m;
  model::ChainData chain(loop.device.chain);
  chain.update(q, Eigen::VectorXd::Zero(q.size()));
  const MatrixM M = plant.link_mass * chain.M().bottomRightCorner(n, n);
  return {q, chain.c().tail(n),
          matrix_exponential(plant_with_input(plant, M) * (loop.device.dt() / kPlantSteps))};
}

// One period of the loop with the gains for `latency` as a matrix: the states that follow the unit
// states, as columns.
Eigen::MatrixXd period_of(const Loop& loop, const Arm& arm, double latency,
                          const TruePlant& plant) {
  const DiscreteDelay delay(plant.loop.latency, loop.device.dt());
  const LinearObservers observers(loop.filters, loop.device.dt());
  const Layout at = {loop.device.n_m, delay.slots()};
  const int n = at.n, size = at.size();
  const Eigen::MatrixXd now = Eigen::MatrixXd::Identity(size, size);
  const auto theta = now.middleRows(0, n), dtheta = now.middleRows(n, n),
             q = now.middleRows(2 * n, n), dq = now.middleRows(3 * n, n);
  Eigen::MatrixXd next = now;
  for (int i = 0; i < size; ++i) {
    observers.advance(theta.col(i), q.col(i), Eigen::VectorXd::Zero(n),
                      next.col(i).segment(at.observers(), 4 * n));
  }

  Eigen::MatrixXd seen(5 * n, size);  // theta, theta', q, q', joint torque
  seen << theta, next.middleRows(at.observers() + n, 3 * n), Eigen::MatrixXd::Zero(n, size);
  for (int i = 0; i < n; ++i) {
    const ActuatorModel& actuator = plant.actuators[i];
    seen.row(4 * n + i) = actuator.stiffness * (theta.row(i) - q.row(i)) +
                          actuator.damping * (dtheta.row(i) - dq.row(i));
  }

  // the plant under the commands that arrive during this period, the oldest first
  Eigen::MatrixXd commands((at.slots + 1) * n, size);
  commands << now.bottomRows(at.slots * n), feedback(loop, arm.q, arm.weight, latency) * seen;
  Eigen::MatrixXd x(6 * n, size);
  x.topRows(5 * n) = now.topRows(5 * n);
  for (int i = 0; i < kPlantSteps; ++i) {
    x.bottomRows(n) = commands.middleRows((at.slots - delay.age(i)) * n, n);
    x = arm.step * x;
  }
  next.topRows(5 * n) = x.topRows(5 * n);
  next.bottomRows(at.slots * n) = commands.bottomRows(at.slots * n);
  return next;
}

TruePlant as_modelled(const Loop& loop, double latency) {
  TruePlant plant = {loop.device.actuators, loop.config.loop};
  plant.loop.latency = latency;
  return plant;
}

// Numbers of a loop in given postures, on which its stability depends.
class Numbers {
 public:
  void add(double value) { values_.push_back(value); }
  void add(const ActuatorModel& actuator) {
    const auto& [rotor_inertia, stiffness, damping, coulomb_friction, viscous_friction,
                 load_friction, stiction, stribeck_speed, presliding, presliding_elements,
                 torque_max, torque_rated, speed_full_torque, speed_no_load] = actuator;
    add_all(rotor_inertia, stiffness, damping, coulomb_friction, viscous_friction, load_friction,
            stiction, stribeck_speed, presliding, presliding_elements, torque_max, torque_rated,
            speed_full_torque, speed_no_load);
  }
  void add(const TorqueLoop& loop) {
    const auto& [latency, current_lag] = loop;
    add_all(latency, current_lag);
  }
  void add(const Poles& poles) {
    const auto& [w0, w1, z1, z2, w2_max, w_motor] = poles;
    add_all(w0, w1, z1, z2, w2_max, w_motor);
  }
  void add(const ControlConfig& config) {
    const auto& [method, loop, latency_max, integral_rate, integral_max, poles, flatness_Hz,
                 wrench_lead, lead_low_pass_Hz, stiff_low_pass_Hz, error_max, friction_share,
                 friction_speed, friction_learning] = config;
    add_all(static_cast<double>(method), loop, latency_max, integral_rate, integral_max, poles,
            flatness_Hz, wrench_lead, lead_low_pass_Hz, stiff_low_pass_Hz, error_max,
            friction_share, friction_speed, friction_learning);
  }
  void add(const LoopFilters& filters) {
    const auto& [link_pole_Hz, motor_low_pass_Hz] = filters;
    add_all(link_pole_Hz, motor_low_pass_Hz);
  }
  template <typename Derived>
  void add(const Eigen::MatrixBase<Derived>& matrix) {
    for (const double value : matrix.reshaped()) add(value);
  }
  template <typename... Parts>
  void add_all(const Parts&... parts) {
    (add(parts), ...);
  }

  auto operator<=>(const Numbers&) const = default;

 private:
  std::vector<double> values_;
};

// The arm takes part by its mass matrix and weight in each posture.
Numbers numbers_of(const Loop& loop, const std::vector<Eigen::VectorXd>& postures) {
  Numbers numbers;
  numbers.add_all(loop.config, loop.filters, loop.device.rate_Hz);
  for (const ActuatorModel& actuator : loop.device.actuators) numbers.add(actuator);
  model::ChainData chain(loop.device.chain);
  for (const Eigen::VectorXd& q : postures) {
    chain.update(q, Eigen::VectorXd::Zero(q.size()));
    numbers.add_all(q, chain.M(), chain.c());
  }
  return numbers;
}

int search_latency(const Loop& loop, const std::vector<Eigen::VectorXd>& postures, int most,
                   int least) {
  for (const Eigen::VectorXd& q : postures) {
    const Arm arm = arm_at(q, loop, as_modelled(loop, 0.0));
    for (int periods = least; periods <= most; ++periods) {
      const double latency = periods * loop.device.dt();
      if (!has_decaying_powers(period_of(loop, arm, latency, as_modelled(loop, latency)))) {
        most = periods - 1;  // and what is longer does not matter in other postures
      }
    }
  }
  return most;
}

}  // namespace

double spectral_radius(const Loop& loop, const Eigen::VectorXd& q, double latency) {
  return spectral_radius(loop, q, latency, as_modelled(loop, latency));
}

double spectral_radius(const Loop& loop, const Eigen::VectorXd& q, double latency,
                       const TruePlant& plant) {
  return hg::spectral_radius(period_of(loop, arm_at(q, loop, plant), latency, plant));
}

// Campaigns make hundreds of cycles of one device: what was found for the same numbers is kept.
int longest_stable_latency(const Loop& loop, const std::vector<Eigen::VectorXd>& postures, int most,
                           int least) {
  static std::mutex mutex;
  static std::map<Numbers, int> found;
  Numbers numbers = numbers_of(loop, postures);
  numbers.add_all(most, least);
  {
    const std::scoped_lock lock(mutex);
    if (const auto known = found.find(numbers); known != found.end()) return known->second;
  }
  const int periods = search_latency(loop, postures, most, least);
  constexpr std::size_t kMostKept = 64;
  const std::scoped_lock lock(mutex);
  if (found.size() == kMostKept) found.clear();
  found.emplace(std::move(numbers), periods);
  return periods;
}

}  // namespace hg::tracking
