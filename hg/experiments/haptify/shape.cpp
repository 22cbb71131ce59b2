#include "hg/experiments/haptify/shape.h"

#include <cmath>
#include <utility>
#include <vector>

#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"

namespace hg::haptify {
namespace {

// Joints and virtual joints of a posture (gantry first) that stand at a limit beyond which the
// handle would go farther along `axis`, to the side of the sign of `side`.
std::vector<std::pair<std::string, double>> binding_limits(const DeviceModel& model,
                                                           const Eigen::VectorXd& q, int axis,
                                                           double side) {
  constexpr double kNear = 0.02;   // rad
  constexpr double kMoves = 1e-3;  // m/rad; what moves it less does not end its way
  model::ChainData chain(model.chain);
  chain.update(q, Eigen::VectorXd::Zero(chain.model().nv()));
  const Eigen::VectorXd gain =
      side * chain.jacobian(model.handle).row(axis).tail(model.n_m).transpose();
  const Eigen::VectorXd arm = q.tail(model.n_m);
  std::vector<std::pair<std::string, double>> found;
  const auto add = [&](const std::string& name, const limits::JointLimits& range, double value,
                       double up, double down) {
    if (value > range.q_max - kNear && up > kMoves) found.emplace_back(name, range.q_max);
    if (value < range.q_min + kNear && down > kMoves) found.emplace_back(name, range.q_min);
  };
  for (Eigen::Index i = 0; i < arm.size(); ++i) {
    const std::size_t joint = model.n_p + i;
    add(model.chain.joints()[joint].name, model.joint_limits[i], arm[i], gain[i], -gain[i]);
  }
  for (const VirtualJoint& joint : model.virtual_joints) {
    const Eigen::VectorXd gains = joint.weights.cwiseProduct(gain);
    add(joint.name, joint.limits, joint.weights.dot(arm), gains.maxCoeff(), -gains.minCoeff());
  }
  return found;
}

// The posture of those drawn that brings the handle farthest along `axis`, `side` = -1 or 1; empty
// when the limits permit none.
Eigen::VectorXd farthest(const config::DeviceConfig& device, const ShapeConfig& config,
                         std::uint64_t seed, int axis, double side) {
  Random random(seed);
  const workspace::JointRanges ranges = workspace::joint_ranges(device);
  model::ChainData chain(device.model.chain);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(chain.model().nv());
  Eigen::VectorXd best;
  double most = 0.0;
  for (int i = 0; i < config.postures; ++i) {
    const auto q = workspace::draw(device, ranges, true, random);
    if (!q) break;
    chain.update_kinematics(*q, zero);
    if (!workspace::permits_boxes(device.model, chain)) continue;
    const double reach = side * chain.pose(device.model.handle).p[axis];
    if (best.size() > 0 && reach <= most) continue;
    most = reach;
    best = *q;
  }
  return best;
}

}  // namespace

workspace::HandleWorkspace measure_shape(const config::DeviceConfig& device,
                                         const ShapeConfig& config, std::uint64_t seed) {
  Random random(seed);
  workspace::Survey survey;
  survey.options.seed = seed;
  survey.cloud = workspace::cloud(device, config.postures, true, random);
  return workspace::workspace(device, survey);
}

std::vector<View> workspace_views(const config::DeviceConfig& device, const ShapeConfig& config,
                                  std::uint64_t seed) {
  constexpr double kCell = 0.05;  // m
  Random random(seed);
  const workspace::Cloud cloud = workspace::cloud(device, config.postures, true, random);
  Eigen::AlignedBox3d bounds;
  for (const auto& position : cloud.positions) bounds.extend(position.p);
  if (cloud.positions.empty()) return {};
  const Eigen::AlignedBox3d limits = workspace::handle_box(device.model);
  std::vector<View> views;
  for (const auto& [across, up] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
    View view = {.across = across,
                 .up = up,
                 .left = bounds.min()[across],
                 .bottom = bounds.min()[up],
                 .cell = kCell};
    const auto cells = [&](int axis, double value) {
      return static_cast<std::size_t>((value - bounds.min()[axis]) / kCell);
    };
    view.rows.assign(cells(up, bounds.max()[up]) + 1,
                     std::vector<int>(cells(across, bounds.max()[across]) + 1, 0));
    for (const auto& position : cloud.positions) {
      view.rows[cells(up, position.p[up])][cells(across, position.p[across])] += 1;
    }
    view.box = {limits.min()[across], limits.max()[across], limits.min()[up], limits.max()[up]};
    views.push_back(std::move(view));
  }
  return views;
}

std::vector<UnreachedSide> unreached_sides(const config::DeviceConfig& device,
                                           const workspace::HandleWorkspace& shape,
                                           const ShapeConfig& config, std::uint64_t seed) {
  constexpr double kReached = 2e-3;  // m
  if (!shape.has_box) return {};
  const Eigen::AlignedBox3d box = workspace::handle_box(device.model);
  std::vector<UnreachedSide> sides;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const double limit = side < 0.0 ? box.min()[axis] : box.max()[axis];
      const double reached = side < 0.0 ? shape.bounds.min()[axis] : shape.bounds.max()[axis];
      const double short_by = side * (limit - reached);
      if (short_by < kReached) continue;
      const Eigen::VectorXd q = farthest(device, config, seed, axis, side);
      sides.push_back({.axis = axis,
                       .limit = limit,
                       .short_by = short_by,
                       .volume = short_by * box.volume() / box.sizes()[axis]});
      if (q.size() > 0) sides.back().at_limit = binding_limits(device.model, q, axis, side);
    }
  }
  return sides;
}

}  // namespace hg::haptify
