#include "hg/page/hand_analysis.h"

#include <algorithm>

#include "hg/core/linear_algebra.h"
#include "hg/model/joint_range.h"
#include "hg/workspace/postures.h"

namespace hg::page {
namespace {

constexpr int kPostures = 2000;

double best_dexterity(DeviceModel& device) {
  std::vector<Interval> ranges = workspace::joint_ranges(device.chain);
  for (int i = 0; i < device.n_m; ++i) {
    const auto& limits = device.joint_limits[i];
    const std::size_t joint = device.n_p + i;
    const bool is_angle = !device.chain.joints()[joint].is_slide();
    ranges[joint] = model::finite_range({limits.q_min, limits.q_max}, is_angle);
  }
  workspace::PostureSampler sampler(ranges);
  model::ChainData chain(device.chain);
  double best = 0.0;
  for (int i = 0; i < kPostures; ++i) {
    best = std::max(best, workspace::dexterity(chain, device.handle, device.n_p, sampler.draw()));
  }
  return best;
}

}  // namespace

HandAnalysis::HandAnalysis(const config::Scenario& scenario)
    : twin_(scenario.twin.model.chain),
      end_effector_(scenario.twin.model.end_effector),
      device_(scenario.device.model),
      device_chain_(device_.chain),
      best_(best_dexterity(device_)) {}

viewer_server::HandBudget HandAnalysis::budget(const CycleRecord& record) {
  viewer_server::HandBudget budget;
  budget.user = budget.rest = record.robot.w_H;
  const TwinState& twin = record.twin;
  if (twin.q_a.size() != twin_.model().nq() || twin.dq_a.size() != twin_.model().nv())
    return budget;
  twin_.update_kinematics(twin.q_a, twin.dq_a);
  const Eigen::MatrixXd J_transposed = twin_.jacobian(end_effector_).transpose();
  const LeastSquares decomposition(J_transposed);
  const auto at_hand = [&](const VectorA& tau) -> Vector6 {
    if (tau.size() != twin_.model().nv()) return Vector6::Zero();
    const Vector6 w = decomposition.solve(tau).cwiseQuotient(record.felt_scale);
    budget.rest -= w;
    return w;
  };
  budget.inertia = at_hand(record.budget.inertia);
  budget.damping = at_hand(record.budget.damping);
  budget.spring = at_hand(record.budget.spring);
  budget.friction = at_hand(record.budget.friction);
  budget.surface = at_hand(record.budget.surface);
  budget.limits = at_hand(record.budget.limits);
  budget.conflict = at_hand(record.budget.conflict);
  budget.structure = record.budget.structure;
  budget.rest -= budget.structure;
  return budget;
}

std::optional<viewer_server::Singularity> HandAnalysis::singularity(const CycleRecord& record) {
  const bool has_posture = record.robot.q_p.size() == device_.n_p &&
                           record.reference.q_m.size() == device_.n_m && best_ > 0.0;
  if (!has_posture) return {};
  Eigen::VectorXd q(device_.n_p + device_.n_m);
  q << record.robot.q_p, record.reference.q_m;
  const double now = workspace::dexterity(device_chain_, device_.handle, device_.n_p, q);
  viewer_server::Singularity singularity{std::clamp(now / best_, 0.0, 1.0)};
  double nearest = kInfinity;
  for (int i = 0; i < static_cast<int>(device_.virtual_joints.size()); ++i) {
    const LimitReport& report = record.limits[device_.n_m + i];
    const double distance = std::min(report.to_lower, report.to_upper);
    if (distance >= nearest) continue;
    nearest = distance;
    singularity.limit = device_.n_m + i;
  }
  return singularity;
}

}  // namespace hg::page
