#include "hg/workspace/workspace.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "hg/model/chain_data.h"

namespace hg::workspace {
namespace {

constexpr double kPointsPerVoxel = 40.0;  // so that hardly any stays empty by chance

// Posture that shows the nominal orientation: the goals, otherwise the middle of the ranges.
Eigen::VectorXd nominal_posture(const DeviceModel& model, const JointRanges& ranges) {
  Eigen::VectorXd q = 0.5 * (ranges.lower + ranges.upper);
  for (Eigen::Index i = 0; i < model.posture.size(); ++i) {
    if (!std::isnan(model.posture[i])) q[model.n_p + i] = model.posture[i];
  }
  return q;
}

// Turns the handle of `q` to R_B_H with damped Gauss-Newton steps of the manipulator; false where
// that leaves the joint limits.
bool turn_handle(const DeviceModel& model, const JointRanges& ranges, const Eigen::Matrix3d& R_B_H,
                 model::ChainData& chain, Eigen::VectorXd& q) {
  constexpr int kSteps = 10;
  constexpr double kReached = 1e-3, kStepMax = 0.5;  // rad
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q.size());
  for (int i = 0; i < kSteps; ++i) {
    chain.update_kinematics(q, zero);
    const Eigen::AngleAxisd error(R_B_H * chain.pose(model.handle).R.transpose());
    if (std::abs(error.angle()) < kReached) {
      return (q.array() >= ranges.lower.array()).all() &&
             (q.array() <= ranges.upper.array()).all() && permits_virtual_joints(model, q);
    }
    const Eigen::Matrix3Xd J = manipulator_jacobian(model, chain, model.handle).bottomRows<3>();
    const Eigen::Matrix3d damped = J * J.transpose() + 1e-4 * Eigen::Matrix3d::Identity();
    const double angle = std::clamp(error.angle(), -kStepMax, kStepMax);
    q.tail(model.n_m) += J.transpose() * damped.ldlt().solve(angle * error.axis());
  }
  return false;
}

Eigen::AlignedBox3d bounds_of(const Cloud& points) {
  Eigen::AlignedBox3d bounds;
  for (const Position& position : points.positions) bounds.extend(position.p);
  return bounds;
}

double filled_volume(const Cloud& points) {
  if (points.positions.empty()) return 0.0;
  const Eigen::AlignedBox3d bounds = bounds_of(points);
  const auto count = static_cast<double>(points.positions.size());
  VoxelGrid grid(bounds, std::cbrt(bounds.volume() * kPointsPerVoxel / count));
  for (const Position& position : points.positions) grid.touch(position.p);
  return grid.volume();
}

double share_in_nominal_orientation(const config::DeviceConfig& device, const Survey& survey,
                                    const Eigen::AlignedBox3d& box, Eigen::Vector3d& axis) {
  constexpr int kPostures = 20'000;
  const DeviceModel& model = device.model;
  const JointRanges ranges = joint_ranges(device);
  model::ChainData chain(model.chain);
  chain.update_kinematics(nominal_posture(model, ranges),
                          Eigen::VectorXd::Zero(chain.model().nv()));
  const Eigen::Matrix3d R_B_H = chain.pose(model.handle).R;
  axis = R_B_H.col(2);

  Random random(survey.options.seed);
  const Cloud points =
      cloud(device, kPostures, true, random, [&](model::ChainData& moved, Eigen::VectorXd& q) {
        return turn_handle(model, ranges, R_B_H, moved, q);
      });
  return filled_volume(points) / box.volume();
}

}  // namespace

VoxelGrid::VoxelGrid(const Eigen::AlignedBox3d& box, double edge) : box_(box) {
  constexpr double kMost = 100.0;  // voxels along one axis: a long reach gets coarser ones
  for (int axis = 0; axis < 3; ++axis) {
    const double length = box.sizes()[axis];
    count_[axis] = static_cast<int>(std::clamp(std::round(length / edge), 1.0, kMost));
    edge_[axis] = length / count_[axis];
  }
  touched_.assign(count_.prod(), 0);
}

void VoxelGrid::touch(const Eigen::Vector3d& point) {
  if (!box_.contains(point)) return;
  Eigen::Vector3i cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = (point[axis] - box_.min()[axis]) / edge_[axis];
    cell[axis] = std::clamp(static_cast<int>(share), 0, count_[axis] - 1);
  }
  touched_[index(cell)] = 1;
}

double VoxelGrid::volume() const {
  double voxels = 0.0;
  Eigen::Vector3i cell;
  for (cell[0] = 0; cell[0] < count_[0]; ++cell[0]) {
    for (cell[1] = 0; cell[1] < count_[1]; ++cell[1]) {
      for (cell[2] = 0; cell[2] < count_[2]; ++cell[2]) {
        if (!is_touched(cell)) continue;
        const bool is_edge = !are_neighbours_touched(cell);
        voxels += is_edge ? 0.5 : 1.0;
      }
    }
  }
  return voxels * edge_.prod();
}

bool VoxelGrid::are_neighbours_touched(const Eigen::Vector3i& cell) const {
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (!is_touched(cell + Eigen::Vector3i(x, y, z))) return false;
      }
    }
  }
  return true;
}

bool VoxelGrid::is_touched(const Eigen::Vector3i& cell) const {
  const bool is_outside = (cell.array() < 0).any() || (cell.array() >= count_.array()).any();
  return is_outside || touched_[index(cell)] != 0;
}

std::size_t VoxelGrid::index(const Eigen::Vector3i& cell) const {
  return (cell[0] * count_[1] + cell[1]) * count_[2] + cell[2];
}

Eigen::AlignedBox3d handle_box(const DeviceModel& model) {
  const std::array<limits::JointLimits, 3> limits = handle_limits(model);
  return {Eigen::Vector3d(limits[0].q_min, limits[1].q_min, limits[2].q_min),
          Eigen::Vector3d(limits[0].q_max, limits[1].q_max, limits[2].q_max)};
}

HandleWorkspace workspace(const config::DeviceConfig& device, const Survey& survey) {
  HandleWorkspace result;
  result.nominal_axis.setZero();
  if (survey.cloud.positions.empty()) return result;
  result.bounds = bounds_of(survey.cloud);

  const Eigen::AlignedBox3d box = handle_box(device.model);
  result.has_box = box.min().allFinite() && box.max().allFinite();
  result.volume = filled_volume(survey.cloud);
  if (result.has_box) {
    result.box_volume = box.volume();
    result.share_any = result.volume / result.box_volume;
    result.share_nominal = share_in_nominal_orientation(device, survey, box, result.nominal_axis);
  }
  return result;
}

}  // namespace hg::workspace
