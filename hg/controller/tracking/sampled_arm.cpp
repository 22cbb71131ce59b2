#include "hg/controller/tracking/sampled_arm.h"

#include <algorithm>
#include <cmath>

#include "hg/controller/estimation/joint_observer.h"
#include "hg/controller/estimation/low_pass.h"
#include "hg/core/linear_algebra.h"

namespace hg::tracking {

Eigen::MatrixXd plant_with_input(const TruePlant& plant, const MatrixM& M) {
  const int n = static_cast<int>(M.rows());
  Eigen::VectorXd J_m(n), K(n), D(n), viscous(n), bristles = Eigen::VectorXd::Zero(n);
  if (plant.bristles.size() > 0) bristles = plant.bristles;
  for (int i = 0; i < n; ++i) {
    const ActuatorModel& actuator = plant.actuators[i];
    J_m[i] = actuator.rotor_inertia;
    K[i] = actuator.stiffness;
    D[i] = actuator.damping;
    viscous[i] = actuator.viscous_friction;
  }
  const Eigen::MatrixXd M_inverse = inverse(M);
  const Eigen::VectorXd J_m_inverse = J_m.cwiseInverse();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  const auto block = [&](int row, int column) { return A.block(row * n, column * n, n, n); };
  block(0, 1).setIdentity();
  block(2, 3).setIdentity();
  block(1, 0) = (-J_m_inverse.cwiseProduct(K + bristles)).asDiagonal();
  block(1, 1) = (-J_m_inverse.cwiseProduct(D + viscous)).asDiagonal();
  block(1, 2) = J_m_inverse.cwiseProduct(K).asDiagonal();
  block(1, 3) = J_m_inverse.cwiseProduct(D).asDiagonal();
  block(1, 4) = J_m_inverse.asDiagonal();
  block(3, 0) = M_inverse * K.asDiagonal();
  block(3, 1) = M_inverse * D.asDiagonal();
  block(3, 2) = -(M_inverse * K.asDiagonal());
  block(3, 3) = -(M_inverse * D.asDiagonal());
  const double rate = 1.0 / std::max(plant.loop.current_lag, 1e-6);
  block(4, 4) = -rate * Eigen::MatrixXd::Identity(n, n);
  block(4, 5) = rate * Eigen::MatrixXd::Identity(n, n);
  return A;
}

DiscreteDelay::DiscreteDelay(double latency_s, double period_s)
    : steps_(static_cast<int>(std::lround(latency_s / period_s * kPlantSteps))) {}

int DiscreteDelay::age(int step) const {
  // the command of k periods ago has arrived when k kPlantSteps + step >= steps_
  return std::clamp((steps_ - step + kPlantSteps - 1) / kPlantSteps, 0, slots());
}

LinearObservers::LinearObservers(const LoopFilters& filters, double period_s)
    : dt_(period_s),
      motor_pole_(estimation::low_pass_pole(filters.motor_low_pass_Hz, period_s)),
      link_pole_(estimation::low_pass_pole(filters.link_pole_Hz, period_s)) {}

void LinearObservers::advance(const Eigen::VectorXd& theta, const Eigen::VectorXd& q,
                              const Eigen::VectorXd& ddq,
                              Eigen::Ref<Eigen::VectorXd> observed) const {
  const Eigen::Index n = theta.size();
  for (Eigen::Index i = 0; i < n; ++i) {
    estimation::MotorObserver motor{observed[i], observed[n + i]};
    estimation::observe(motor_pole_, dt_, theta[i], motor);
    estimation::LinkObserver link{observed[2 * n + i], observed[3 * n + i]};
    estimation::observe(link_pole_, dt_, ddq[i], q[i], link);
    observed[i] = motor.theta;
    observed[n + i] = motor.dtheta;
    observed[2 * n + i] = link.q;
    observed[3 * n + i] = link.dq;
  }
}

RobotState standing(const std::vector<ActuatorModel>& actuators, const Eigen::VectorXd& q,
                    const VectorM& weight) {
  const Eigen::Index n = weight.size(), n_p = q.size() - n;
  RobotState robot;
  robot.q_m = robot.theta_m = q.tail(n);
  robot.tau_m = weight;
  for (Eigen::Index i = 0; i < n; ++i) {
    robot.theta_m[i] += weight[i] / actuators[i].stiffness;
  }
  robot.dq_m = robot.dtheta_m = VectorM::Zero(n);
  robot.q_p = q.head(n_p);
  robot.dq_p = robot.ddq_p = VectorP::Zero(n_p);
  return robot;
}

ReferenceState standing_reference(const RobotState& robot) {
  return {.q_m = robot.q_m, .dq_m = robot.dq_m, .ddq_m = robot.dq_m};
}

}  // namespace hg::tracking
