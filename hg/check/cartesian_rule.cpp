#include "hg/check/cartesian_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/model/chain_data.h"

namespace hg::check {
namespace {

constexpr double kReserve = 0.5;  // share of the joints' ratings that one row may use
constexpr double kRare = 0.01, kFew = 0.05, kMany = 0.25;  // shares of postures

// Less than this share of the values is below it.
double low(std::vector<double>& values, double share) {
  if (values.empty()) return kInfinity;
  const auto index =
      static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
  std::ranges::nth_element(values, values.begin() + index);
  return values[index];
}

double share_below(const std::vector<double>& values, double limit) {
  const auto count = std::ranges::count_if(values, [&](double value) { return value < limit; });
  return values.empty() ? 0.0 : static_cast<double>(count) / static_cast<double>(values.size());
}

// Where the row can act: closer to a face than the braking distance.
bool is_near_face(const limits::JointLimits& limits, double p) {
  const double distance = limits.dq_max * limits.dq_max / (2.0 * limits.ddq_max);
  return p - limits.q_min < distance || limits.q_max - p < distance;
}

bool is_limited(const limits::JointLimits& limits) {
  return (std::isfinite(limits.q_min) || std::isfinite(limits.q_max)) &&
         std::isfinite(limits.ddq_max);
}

}  // namespace

std::vector<CartesianRule> cartesian_rules(const config::DeviceConfig& device,
                                           const workspace::Survey& survey) {
  const DeviceModel& model = device.model;
  const std::size_t n = 3 * model.cartesian_limits.size();
  std::vector<std::vector<double>> values(n);  // half of what the joints give, m/s^2
  model::ChainData chain(model.chain);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(chain.model().nv());
  for (const workspace::Posture& posture : survey.postures) {
    chain.update_kinematics(posture.q, zero);
    for (std::size_t k = 0; k < n; ++k) {
      const CartesianLimit& limit = model.cartesian_limits[k / 3];
      const auto axis = static_cast<Eigen::Index>(k % 3);
      const limits::JointLimits& range = limit.axes[k % 3];
      if (!is_limited(range) || !is_near_face(range, chain.pose(limit.frame).p[axis])) continue;
      const model::Jacobian J = workspace::manipulator_jacobian(model, chain, limit.frame);
      double acceleration = 0.0;
      for (Eigen::Index i = 0; i < J.cols(); ++i) {
        const auto& joint = model.joint_limits[i];
        acceleration += kReserve * std::abs(J(axis, i)) * joint.ddq_max;
      }
      values[k].push_back(acceleration);
    }
  }

  std::vector<CartesianRule> rules;
  for (std::size_t k = 0; k < n; ++k) {
    const limits::JointLimits& range = model.cartesian_limits[k / 3].axes[k % 3];
    if (!is_limited(range)) continue;
    const double too_weak = share_below(values[k], range.ddq_max);
    const double weak = too_weak > kFew ? kFew : kRare;
    rules.push_back({.limit = static_cast<int>(k / 3),
                     .axis = static_cast<int>(k % 3),
                     .postures = static_cast<int>(values[k].size()),
                     .share_too_weak = too_weak,
                     .share_weak = weak,
                     .low_acceleration = low(values[k], weak)});
  }
  return rules;
}

void inspect_cartesian_rule(const config::DeviceConfig& device, const workspace::Survey& survey,
                            Collector& out) {
  for (const CartesianRule& rule : cartesian_rules(device, survey)) {
    if (rule.share_too_weak < kRare) continue;
    const auto& limit = device.model.cartesian_limits[rule.limit];
    const auto& range = limit.axes[rule.axis];
    out.add(
        rule.share_too_weak > kMany ? Severity::kWarning : Severity::kNote,
        fmt::format("cartesian_limits[{}].ddq_max_m_per_s2", rule.limit),
        fmt::format("braking {} with {:g} m/s^2 along {} takes more than half of what the joints "
                    "can give in {:.0f} % of the postures near this limit, and overshoots there",
                    limit.name, range.ddq_max, "xyz"[rule.axis], 100.0 * rule.share_too_weak),
        fmt::format("{} m/s^2 would do in {:.0f} % of them; or raise the joints' ddq_max, or "
                    "margin_m",
                    rounded_down(rule.low_acceleration, 2), 100.0 * (1.0 - rule.share_weak)));
  }
}

}  // namespace hg::check
