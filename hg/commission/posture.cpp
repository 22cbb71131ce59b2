#include "hg/commission/posture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/commission/stroke.h"

namespace hg::commission {
namespace {

using Eigen::Vector3d;

constexpr double kCounts = 3.0;        // Nm of weight from which a torque sensor shows it
constexpr double kTorqueRatio = 0.25;  // of the weight by which it may be wrong
constexpr double kStep = 0.01;         // rad, of the search for a joint's true position
constexpr double kParallel = 0.17;     // rad between axes that count as parallel

double misfit_at(const AtRest& measured, const VectorPM& q, const DeviceModel& device,
                 model::ChainData& chain) {
  chain.update_poses(q);
  const Eigen::Matrix3d R_B_S = chain.pose(device.handle).R * device.T_H_S.R;
  double most = 0.0;
  for (const Direction& seen : measured.directions) {
    most = std::max(most, angle_between(R_B_S * seen.in_S, seen.in_B) / seen.within);
  }
  return most;
}

double weight_allowed(double weight) { return std::max(kCounts, kTorqueRatio * std::abs(weight)); }

// Whether the torque sensors fit to a posture, that of joint i of the manipulator with either sign;
// true without any.
bool fits_torques(AtRest measured, const VectorPM& q, int i, const DeviceModel& device,
                  model::ChainData& chain) {
  measured.q = q;
  int counted = 0;
  if (wrong_torque(measured, device, chain, counted) < 0) return true;
  measured.tau[i] = -measured.tau[i];
  return wrong_torque(measured, device, chain, counted) < 0;
}

}  // namespace

double misfit(const AtRest& measured, const DeviceModel& device, model::ChainData& chain) {
  return misfit_at(measured, measured.q, device, chain);
}

int wrong_torque(const AtRest& measured, const DeviceModel& device, model::ChainData& chain,
                 int& counted) {
  counted = 0;
  if (measured.tau.size() != device.n_m) return -1;
  chain.update(measured.q, Eigen::VectorXd::Zero(measured.q.size()));
  const VectorM weight = chain.gravity().tail(device.n_m);
  int wrong = -1;
  for (int i = device.n_m - 1; i >= 0; --i) {
    const bool carries = std::abs(weight[i]) >= kCounts;
    counted += carries ? 1 : 0;
    if (std::abs(measured.tau[i] - weight[i]) > weight_allowed(weight[i])) wrong = i;
  }
  return wrong;
}

std::string explain(const AtRest& measured, const DeviceModel& device, model::ChainData& chain) {
  std::vector<std::string> words;
  const int n = device.n_p + device.n_m;
  for (int i = device.n_p; i < n; ++i) {
    if (device.chain.joints()[i].is_slide()) continue;
    VectorPM q = measured.q;
    double best = kInfinity, at = 0.0;
    for (double there = -M_PI; there < M_PI; there += kStep) {
      q[i] = there;
      const double here = misfit_at(measured, q, device, chain);
      if (here >= best) continue;
      best = here;
      at = there;
    }
    q[i] = at;
    if (best > 1.0 || !fits_torques(measured, q, i - device.n_p, device, chain)) continue;
    words.push_back(
        fmt::format("{} were at {:.2f} rad and not at {:.2f} (zero position, sign or "
                    "gear ratio of its encoder)",
                    name_of(device, i), at, measured.q[i]));
  }
  for (int i = device.n_p; i < n; ++i) {
    for (int k = i + 1; k < n; ++k) {
      AtRest swapped = measured;
      std::swap(swapped.q[i], swapped.q[k]);
      if (measured.tau.size() == device.n_m) {
        std::swap(swapped.tau[i - device.n_p], swapped.tau[k - device.n_p]);
      }
      if (misfit(swapped, device, chain) > 1.0 ||
          !fits_torques(swapped, swapped.q, i - device.n_p, device, chain)) {
        continue;
      }
      words.push_back(
          fmt::format("{} and {} were swapped", name_of(device, i), name_of(device, k)));
    }
  }
  return fmt::format("{}", fmt::join(words, ", or if "));
}

std::string unseen_zeros(const VectorPM& q, const DeviceModel& device, model::ChainData& chain) {
  chain.update_kinematics(q, Eigen::VectorXd::Zero(q.size()));
  const model::Jacobian& J = chain.jacobian(device.handle);
  const auto is_parallel = [](const Vector3d& a, const Vector3d& b) {
    const double angle = angle_between(a, b);
    return angle < kParallel || M_PI - angle < kParallel;
  };
  std::vector<std::string> names;
  for (int i = device.n_p; i < device.n_p + device.n_m; ++i) {
    const Vector3d axis = J.col(i).tail<3>();
    if (axis.isZero() || !is_parallel(axis, Vector3d::UnitZ())) continue;
    bool is_seen = false;
    for (int k = device.n_p; k < i; ++k) {
      const Vector3d before = J.col(k).tail<3>();
      is_seen = is_seen || (!before.isZero() && !is_parallel(axis, before));
    }
    if (!is_seen) names.push_back(name_of(device, i));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace hg::commission
