#include "hg/design/device_metrics.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "hg/core/error.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/capability.h"
#include "hg/model/chain_data.h"
#include "hg/model/inverse_kinematics.h"
#include "hg/model/joint_range.h"
#include "hg/model/urdf.h"

namespace hg::design {
namespace {

using model::haptic_giant::Branch;
using model::haptic_giant::InverseStatus;
using model::haptic_giant::Lengths;
using std::numbers::pi;

constexpr double kLow = 0.05, kHigh = 0.95;

void check(const MetricOptions& options, const HumanCapability& human) {
  const auto require = [](bool holds, const char* rule, double got) {
    if (!holds) throw SetupError(fmt::format("metrics: {}, got {}", rule, got));
  };
  require(!human.poses.empty(), "poses of the hand: at least one", 0.0);
  require(options.directions >= 1, "directions: at least 1", options.directions);
  require(options.length > 0.0, "length: above 0 m", options.length);
  require(options.condition_max > 1.0, "condition_max: above 1", options.condition_max);
}

bool permits_virtual_joints(const DeviceModel& device, const Eigen::Ref<const VectorM>& q_m) {
  return std::ranges::all_of(device.virtual_joints, [&](const VirtualJoint& joint) {
    const double sum = joint.weights.dot(q_m);
    return sum >= joint.limits.q_min && sum <= joint.limits.q_max;
  });
}

bool permits_joints(const DeviceModel& device, const VectorM& q_m) {
  for (int i = 0; i < device.n_m; ++i) {
    const limits::JointLimits& range = device.joint_limits[i];
    if (q_m[i] < range.q_min || q_m[i] > range.q_max) return false;
  }
  return permits_virtual_joints(device, q_m);
}

bool permits(const limits::JointLimits& range, double x) {
  return x >= range.q_min && x <= range.q_max;
}

// The gantry is where it has to be: only heights count. Of the branches within all limits the one
// farthest from a singularity.
bool reach_in_closed_form(const DeviceModel& device, const Lengths& lengths,
                          const std::array<limits::JointLimits, 3>& box, const Pose& T_B_H,
                          Eigen::VectorXd& q) {
  if (!permits(box[2], T_B_H.p.z())) return false;
  double best = 0.0;
  for (const auto& [f, w] : {std::pair{1, 1}, {1, -1}, {-1, 1}, {-1, -1}}) {
    Eigen::Vector2d q_p;
    Vector6 q_m;
    const InverseStatus status =
        model::haptic_giant::inverse_at_target(T_B_H, q_p, q_m, Branch{.f = f, .w = w}, lengths);
    if (status != InverseStatus::kSolved || !permits_joints(device, q_m)) continue;
    const double regular = std::abs(std::sin(q_m[3]) * std::sin(q_m[3] + q_m[4]));
    if (regular <= best) continue;
    best = regular;
    q.setZero(8);
    q.tail<6>() = q_m;
  }
  return best > 0.0;
}

// The device's own posture; joints without a goal in the middle of their range.
Eigen::VectorXd middle_posture(const DeviceModel& device) {
  Eigen::VectorXd q(device.chain.nv());
  for (int i = 0; i < device.chain.nv(); ++i) {
    const int joint = i - device.n_p;
    const Interval given =
        joint < 0 ? device.gantry_range[i]
                  : Interval{device.joint_limits[joint].q_min, device.joint_limits[joint].q_max};
    const Interval range = model::finite_range(given, !device.chain.joints()[i].is_slide());
    q[i] = 0.5 * (range.lb + range.ub);
    if (joint >= 0 && joint < device.posture.size() && std::isfinite(device.posture[joint])) {
      q[i] = device.posture[joint];
    }
  }
  return q;
}

bool reach_numerically(const DeviceModel& device, const std::array<limits::JointLimits, 3>& box,
                       const Pose& T_B_H, Eigen::VectorXd& q) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!permits(box[axis], T_B_H.p[axis])) return false;
  }
  const int n = device.chain.nv();
  model::InverseProblem problem = {.frame = device.handle, .T_B_frame = T_B_H};
  problem.q_min.resize(n);
  problem.q_max.resize(n);
  problem.goal = middle_posture(device);
  for (int i = 0; i < n; ++i) {
    const int joint = i - device.n_p;
    problem.q_min[i] = joint < 0 ? device.gantry_range[i].lb : device.joint_limits[joint].q_min;
    problem.q_max[i] = joint < 0 ? device.gantry_range[i].ub : device.joint_limits[joint].q_max;
  }
  problem.permits = [&device](const Eigen::VectorXd& at) {
    return permits_virtual_joints(device, VectorM(at.tail(device.n_m)));
  };
  const model::InverseResult result = model::inverse_kinematics(device.chain, problem);
  q = result.q;
  return result.is_permitted;
}

// Largest torques of the motors, Nm or N; empty where one is unknown.
VectorM motor_torques(const DeviceModel& device) {
  VectorM torques(device.n_m);
  for (int i = 0; i < device.n_m; ++i) {
    torques[i] = device.actuators.empty() ? device.chain.joints()[device.n_p + i].effort_max
                                          : device.actuators[i].torque_max;
  }
  return torques.allFinite() ? torques : VectorM();
}

// The eigenvalues of a symmetric matrix, smallest first.
template <int kSize>
auto eigenvalues(const Eigen::Matrix<double, kSize, kSize>& A) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>>(A,
                                                                            Eigen::EigenvaluesOnly)
      .eigenvalues()
      .eval();
}

using JointMatrix = MatrixUpTo<kMaxManipulator, kMaxManipulator>;
using HandleRows = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxManipulator>;

// What is the same in all postures.
struct Facts {
  VectorM effort, torques, dq_max, ddq_max, rotor, stiffness;
  std::vector<Eigen::Vector3d> directions;
};

Facts facts_of(const DeviceModel& device, const MetricOptions& options) {
  Facts facts;
  const int n = device.n_m;
  for (VectorM* values : {&facts.effort, &facts.dq_max, &facts.ddq_max, &facts.rotor}) {
    values->setZero(n);
  }
  facts.torques = motor_torques(device);
  if (!device.actuators.empty()) facts.stiffness.resize(n);
  for (int i = 0; i < n; ++i) {
    const model::Joint& joint = device.chain.joints()[device.n_p + i];
    facts.effort[i] = joint.effort_max;
    facts.dq_max[i] = std::min(device.joint_limits[i].dq_max, joint.velocity_max);
    facts.ddq_max[i] = device.joint_limits[i].ddq_max;
    if (device.actuators.empty()) continue;
    facts.rotor[i] = device.actuators[i].rotor_inertia;
    facts.stiffness[i] = device.actuators[i].stiffness;
  }
  facts.directions = half_sphere(options.directions);
  return facts;
}

Eigen::Matrix3d ellipsoid(const Eigen::Ref<const MatrixUpTo<3, kMaxManipulator>>& rows) {
  return rows * rows.transpose();
}

// chain: after update() at the posture
void judge(const DeviceModel& device, const Facts& facts, const MetricOptions& options,
           const model::ChainData& chain, const HandPose& hand, const Eigen::Matrix3d& R_B_F,
           PoseMetrics& pose) {
  const int n = device.n_m;
  const HandleRows J = chain.jacobian(device.handle).rightCols(n);
  const JointMatrix M_link = chain.M().bottomRightCorner(n, n);
  const VectorM gravity = chain.gravity().tail(n).cwiseAbs();
  const JointMatrix M = M_link + JointMatrix(facts.rotor.asDiagonal());
  const JointMatrix M_inverse = M.llt().solve(JointMatrix::Identity(n, n));

  const VectorM available = facts.effort - gravity;
  pose.force = model::worst_direction(J.topRows<3>(), available).value;
  pose.torque = model::worst_direction(J.bottomRows<3>(), available).value;
  pose.holds_wrench = model::holds_wrench(chain.jacobian(device.handle).rightCols(n), available,
                                          options.force, options.torque);

  // motion of the handle per unit of each joint's largest speed and acceleration
  const HandleRows speeds = J * facts.dq_max.asDiagonal();
  HandleRows accelerations;
  if (facts.torques.size() == n) {
    accelerations = J * M_inverse * (facts.torques - gravity).cwiseMax(0.0).asDiagonal();
  } else {
    accelerations = J * facts.ddq_max.asDiagonal();
  }
  const auto in_B = [&R_B_F](const Eigen::Matrix3d& S) -> Eigen::Matrix3d {
    return R_B_F * S * R_B_F.transpose();
  };
  const auto coverage = [&](const auto& rows, const Eigen::Matrix3d& S) {
    return relative_coverage(ellipsoid(rows), in_B(S), facts.directions);
  };
  pose.velocity = coverage(speeds.topRows<3>(), hand.velocity);
  pose.turn_velocity = coverage(speeds.bottomRows<3>(), hand.turn_velocity);
  pose.acceleration = coverage(accelerations.topRows<3>(), hand.acceleration);
  pose.turn_acceleration = coverage(accelerations.bottomRows<3>(), hand.turn_acceleration);

  HandleRows scaled = J;
  scaled.topRows<3>() /= options.length;
  const Vector6 singular = eigenvalues<6>(scaled * scaled.transpose());
  pose.condition = singular[0] > 0.0 ? std::sqrt(singular[5] / singular[0]) : kInfinity;

  const Eigen::Matrix3d mobility = J.topRows<3>() * M_inverse * J.topRows<3>().transpose();
  pose.mass = 3.0 / mobility.trace();
  const double least = eigenvalues<3>(mobility)[0];
  pose.mass_worst = least > 0.0 ? 1.0 / least : kInfinity;

  if (facts.stiffness.size() == n) {
    const VectorM softness = facts.stiffness.cwiseSqrt().cwiseInverse();
    const JointMatrix scaled_mass = softness.asDiagonal() * M_link * softness.asDiagonal();
    const double slowest =
        Eigen::SelfAdjointEigenSolver<JointMatrix>(scaled_mass, Eigen::EigenvaluesOnly)
            .eigenvalues()
            .maxCoeff();
    pose.frequency = 1.0 / (2.0 * pi * std::sqrt(slowest));
  }
}

struct Weighted {
  double value, weight;
};

// The value below which `share` of the weight lies.
double quantile(std::vector<Weighted>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  double total = 0.0;
  for (const Weighted& item : sorted) total += item.weight;
  double below = 0.0;
  for (const Weighted& item : sorted) {
    below += item.weight;
    if (below >= share * total) return item.value;
  }
  return sorted.back().value;
}

// Sums of the measures over the poses, from which their means and quantiles come.
struct PoseSums {
  double all = 0.0, reached = 0.0;  // weight
  std::vector<Weighted> force, torque, worst_mass, frequency;

  void add(const PoseMetrics& pose, double weight, const MetricOptions& options,
           DeviceMetrics& metrics) {
    ++metrics.reached;
    reached += weight;
    metrics.velocity += weight * pose.velocity;
    metrics.turn_velocity += weight * pose.turn_velocity;
    metrics.acceleration += weight * pose.acceleration;
    metrics.turn_acceleration += weight * pose.turn_acceleration;
    metrics.share_force += weight * (pose.force >= options.force ? 1.0 : 0.0);
    metrics.share_torque += weight * (pose.torque >= options.torque ? 1.0 : 0.0);
    metrics.share_wrench += weight * (pose.holds_wrench ? 1.0 : 0.0);
    metrics.share_regular += weight * (pose.condition <= options.condition_max ? 1.0 : 0.0);
    metrics.mass_mean += weight * pose.mass;
    force.push_back({pose.force, weight});
    torque.push_back({pose.torque, weight});
    worst_mass.push_back({pose.mass_worst, weight});
    frequency.push_back({pose.frequency, weight});
  }

  void finish(const Facts& facts, DeviceMetrics& metrics) {
    metrics.pose = reached / all;
    for (double* share : {&metrics.velocity, &metrics.turn_velocity, &metrics.acceleration,
                          &metrics.turn_acceleration}) {
      *share /= all;
    }
    if (reached > 0.0) {
      for (double* share : {&metrics.share_force, &metrics.share_torque, &metrics.share_wrench,
                            &metrics.share_regular, &metrics.mass_mean}) {
        *share /= reached;
      }
    }
    for (std::vector<Weighted>* values : {&force, &torque, &worst_mass, &frequency}) {
      std::ranges::sort(*values, {}, &Weighted::value);
    }
    metrics.force = {quantile(force, 0.0), quantile(force, kLow), quantile(force, 0.5)};
    metrics.torque = {quantile(torque, 0.0), quantile(torque, kLow), quantile(torque, 0.5)};
    metrics.mass_worst = quantile(worst_mass, kHigh);
    if (facts.stiffness.size() == 0) return;
    metrics.frequency_median = quantile(frequency, 0.5);
    metrics.frequency_least = quantile(frequency, 0.0);
    metrics.frequency_clamped =
        std::sqrt(facts.stiffness.cwiseQuotient(facts.rotor).minCoeff()) / (2.0 * pi);
  }
};

}  // namespace

Eigen::Matrix3d hand_to_handle(Grip grip) noexcept {
  Eigen::Matrix3d R;
  if (grip == Grip::kAcross) {
    R << Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitX();
  } else {
    R << -Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitZ();
  }
  return R;
}

std::vector<Eigen::Vector3d> half_sphere(int count) {
  const double turn = pi * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double z = (i + 0.5) / count;
    const double radius = std::sqrt(1.0 - z * z);
    directions.emplace_back(radius * std::cos(turn * i), radius * std::sin(turn * i), z);
  }
  return directions;
}

double relative_coverage(const Eigen::Matrix3d& device, const Eigen::Matrix3d& human,
                         const std::vector<Eigen::Vector3d>& directions) {
  if (device.determinant() <= 1e-12 * std::pow(device.trace(), 3)) return 0.0;
  const Eigen::Matrix3d of_device = device.inverse(), of_human = human.inverse();
  double sum = 0.0;
  for (const Eigen::Vector3d& n : directions) {
    sum += std::min(1.0, std::sqrt(n.dot(of_human * n) / n.dot(of_device * n)));
  }
  return sum / static_cast<double>(directions.size());
}

std::optional<Lengths> closed_form(const DeviceModel& device) {
  if (device.n_p != 2 || device.n_m != 6 || !device.is_gantry_slide()) return {};
  for (int i = 0; i < device.n_m; ++i) {
    if (device.is_slide(i)) return {};
  }
  if (device.joint_limits[0].q_min > -kInfinity || device.joint_limits[0].q_max < kInfinity) {
    return {};
  }
  try {
    return model::haptic_giant::lengths_of(device.chain, device.handle);
  } catch (const SetupError&) {
    return {};  // built differently
  }
}

Pose place_person(const DeviceModel& device, const HumanCapability& human,
                  const MetricOptions& options) {
  model::ChainData chain(device.chain);
  chain.update_poses(middle_posture(device));
  const Pose T_B_H = chain.pose(device.handle);
  const Eigen::Vector3d forward = T_B_H.R * hand_to_handle(options.grip).transpose().col(0);
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (const HandPose& hand : human.poses) {
    middle += hand.weight * hand.T_F_hand.p.head<2>();
    weight += hand.weight;
  }
  middle /= weight;
  Pose T_B_F;
  T_B_F.R = Eigen::AngleAxisd(std::atan2(forward.y(), forward.x()), Eigen::Vector3d::UnitZ());
  T_B_F.p << T_B_H.p.head<2>() - T_B_F.R.topLeftCorner<2, 2>() * middle, options.floor_z;
  return T_B_F;
}

MetricOptions metric_options(const config::DeviceConfig& device) {
  MetricOptions options;
  options.floor_z = device.floor_z;
  options.grip = closed_form(device.model) ? Grip::kAcross : Grip::kAlong;

  // all links that the first joint of the arm carries
  const auto text = std::ranges::find_if(device.sources, [&](const config::SourceText& source) {
    return source.name == device.urdf.string();
  });
  if (text == device.sources.end()) return options;
  const model::Urdf urdf = model::read_urdf_text(text->content, text->name);
  std::vector<bool> moves(urdf.links.size(), false);
  for (bool any = true; any;) {
    any = false;
    for (const model::UrdfJoint& joint : urdf.joints) {
      const bool is_first = joint.name == device.model.manipulator_joint(0);
      if ((!is_first && !moves[joint.parent]) || moves[joint.child]) continue;
      moves[joint.child] = any = true;
    }
  }
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (moves[i] && urdf.links[i].inertial) options.moving_mass += urdf.links[i].inertial->mass;
  }
  if (device.chain_options.tool) options.moving_mass += device.chain_options.tool->mass;
  return options;
}

DeviceMetrics measure(const DeviceModel& device, const HumanCapability& human,
                      const MetricOptions& options) {
  check(options, human);
  const std::optional<Lengths> lengths = closed_form(device);
  const std::array<limits::JointLimits, 3> box = handle_limits(device);
  const Facts facts = facts_of(device, options);
  const Pose T_B_F = options.T_B_F.value_or(place_person(device, human, options));
  const Eigen::Matrix3d R_hand_H = hand_to_handle(options.grip);
  model::ChainData chain(device.chain);
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(device.chain.nv());

  DeviceMetrics metrics;
  metrics.poses = static_cast<int>(human.poses.size());
  metrics.has_torques = facts.effort.allFinite();
  metrics.moving_mass = options.moving_mass;
  PoseSums sums;
  for (const HandPose& hand : human.poses) {
    PoseMetrics pose;
    Pose T_B_H = T_B_F * hand.T_F_hand;
    T_B_H.R = T_B_H.R * R_hand_H;
    pose.is_reached = lengths ? reach_in_closed_form(device, *lengths, box, T_B_H, pose.q)
                              : reach_numerically(device, box, T_B_H, pose.q);
    sums.all += hand.weight;
    if (pose.is_reached) {
      chain.update(pose.q, at_rest);
      judge(device, facts, options, chain, hand, T_B_F.R, pose);
      sums.add(pose, hand.weight, options, metrics);
    }
    if (options.keeps_poses) metrics.each.push_back(std::move(pose));
  }
  sums.finish(facts, metrics);
  return metrics;
}

}  // namespace hg::design
