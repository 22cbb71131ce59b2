#include "hg/check/drive_loop.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/core/linear_algebra.h"
#include "hg/model/chain_data.h"

namespace hg::check {
namespace {

using Complex = std::complex<double>;

// The arm about its posture: M q'' = K (theta - q) + J^T F, Jm theta'' = tau - K (theta - q), and
// the loops of PositionLoop, whose commands are reached with the lag of the current.
class DrivenArm {
 public:
  DrivenArm(const config::SimulatedDeviceConfig& device, const VectorPM& q,
            const Eigen::Matrix3Xd& directions)
      : model_(device.model), drives_(device.simulation.drives) {
    model::ChainData chain(model_.chain);
    chain.update(q, Eigen::VectorXd::Zero(q.size()));
    const config::RealityFactors& factors = device.simulation.factors;
    const int n = model_.n_m;
    M_ = factors.mass * chain.M().bottomRightCorner(n, n);
    const Eigen::MatrixXd J = chain.jacobian(model_.handle).rightCols(n);
    levers_ = J.topRows<3>().transpose() * directions;
    inverse_ = LeastSquares(J).pseudo_inverse().leftCols<3>() * directions;
    const auto& known = model_.actuators;
    for (int i = 0; i < n; ++i) {
      motors_.push_back(config::actual(known.empty() ? drives_.actuators[i] : known[i], factors));
      inertia_.push_back(motors_[i].rotor_inertia + M_(i, i) / factors.mass);
    }
  }

  // How the handle follows a command along a direction and yields to a force there, m/m and m/N.
  struct Response {
    Complex follows, yields;
  };
  std::vector<Response> at(Complex s) const {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const int n = model_.n_m;
    const double w_q = kTurn * drives_.loop.position_Hz, w_v = kTurn * drives_.loop.speed_Hz;
    const Complex current = 1.0 / (1.0 + s * drives_.current_lag);
    const Complex per_error = (w_q + s) * (w_v + 0.1 * w_v * w_v / s);
    Eigen::MatrixXcd A = s * s * M_.cast<Complex>();
    Eigen::MatrixXcd driving = Eigen::MatrixXcd::Zero(n, n);
    for (int i = 0; i < n; ++i) {  // without theta
      const ActuatorModel& motor = motors_[i];
      const Complex spring = motor.stiffness + s * motor.damping;
      const Complex held = current * inertia_[i] * per_error;
      const Complex moved = motor.rotor_inertia * s * s + motor.viscous_friction * s + held;
      A(i, i) += spring * moved / (moved + spring);
      driving(i, i) = spring / (moved + spring) * (held + current * inertia_[i] * s * s);
    }
    const Eigen::PartialPivLU<Eigen::MatrixXcd> links(A);
    std::vector<Response> result;
    for (Eigen::Index i = 0; i < levers_.cols(); ++i) {
      const Eigen::VectorXcd lever = levers_.col(i).cast<Complex>();
      const Eigen::VectorXcd driven = driving * inverse_.col(i).cast<Complex>();
      result.push_back({lever.cwiseProduct(links.solve(driven)).sum(),
                        lever.cwiseProduct(links.solve(lever)).sum()});
    }
    return result;
  }

 private:
  const DeviceModel& model_;
  const config::PositionDrives& drives_;
  Eigen::MatrixXd M_, levers_, inverse_;
  std::vector<ActuatorModel> motors_;
  std::vector<double> inertia_;  // that the drives expect
};

Complex impedance(const FeelingHand& hand, Complex s) {
  const Complex arm = hand.stiffness + s * hand.damping + s * s * hand.mass;
  const Complex grip = hand.grip_stiffness + s * hand.grip_damping;
  return arm * grip / (arm + grip);
}

}  // namespace

double drive_delay(const config::SimulatedDeviceConfig& device) {
  const simulator::SensorFilterConfig& filter = device.simulation.sensors.wrench.filter;
  double delay = device.simulation.drives.latency * device.simulation.factors.latency +
                 0.5 * device.model.dt() + 0.5 * filter.average + filter.delay;
  const double low_pass_Hz = device.estimation.wrench.low_pass_Hz;
  if (low_pass_Hz > 0.0) delay += 1.0 / (2.0 * std::numbers::pi * low_pass_Hz);
  return delay;
}

DriveLoop::DriveLoop(const config::SimulatedDeviceConfig& device, const VectorPM& q,
                     const Eigen::Matrix3Xd& directions, const FeelingHand& hand)
    : response_(static_cast<std::size_t>(directions.cols())) {
  constexpr double kFirst_Hz = 0.5, kLast_Hz = 60.0, kRatio = 1.01;
  const DrivenArm arm(device, q, directions);
  const double delay = drive_delay(device);
  const estimation::WrenchConfig& wrench = device.estimation.wrench;
  const double beyond = wrench.has_imu ? 0.0 : wrench.payload.mass;
  for (double f = kFirst_Hz; f < kLast_Hz; f *= kRatio) {
    w_.push_back(2.0 * std::numbers::pi * f);
    const Complex s(0.0, w_.back());
    const Complex felt = impedance(hand, s);
    const auto handle = arm.at(s);
    for (std::size_t i = 0; i < handle.size(); ++i) {
      response_[i].push_back((felt + beyond * s * s) * handle[i].follows * std::exp(-delay * s) /
                             (1.0 + felt * handle[i].yields));
    }
  }
}

double DriveLoop::stiffest_wall(int direction, double mass, double damping) const noexcept {
  double least = kInfinity;
  for (std::size_t i = 0; i < w_.size(); ++i) {
    const Complex response = response_[direction][i];
    if (damping + response.imag() / w_[i] >= 0.0) continue;
    least = std::min(least, mass * w_[i] * w_[i] - response.real());
  }
  return std::max(least, 0.0);
}

double DriveLoop::lightest_mass(int direction, double damping) const noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < w_.size(); ++i) {
    const Complex response = response_[direction][i];
    if (damping + response.imag() / w_[i] >= 0.0) continue;
    most = std::max(most, response.real() / (w_[i] * w_[i]));
  }
  return most;
}

}  // namespace hg::check
