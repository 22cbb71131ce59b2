#include "tests/complaints/start_draw.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hg/core/stacked.h"

namespace hg {
namespace {

constexpr double kLength = 0.3;                      // m, at which a rotation counts
constexpr double kSmallest = 1e-6, kLargest = 2e-2;  // rad and m, beyond a limit
constexpr double kClear = 3e-4;                      // m, beyond the safe distance
constexpr double kInRoom = 5.0;                      // m, of a box that is not in the way
constexpr double kForce = 20.0, kTorque = 2.0;       // N, Nm: the hardest push
constexpr double kOfRating = 0.3;      // of its acceleration that the push asks of any joint
constexpr double kAcceleration = 0.3;  // m/s^2, of the handle: a push that is felt

limits::JointLimits& limits_of(DeviceModel& device, int joint) {
  return device.joint_limits[static_cast<std::size_t>(joint - device.n_p)];
}

Interval range_of(const DeviceModel& device, int joint) {
  if (joint < device.n_p) return device.gantry_range[static_cast<std::size_t>(joint)];
  const auto& limits = device.joint_limits[static_cast<std::size_t>(joint - device.n_p)];
  return {limits.q_min, limits.q_max};
}

Interval to_draw_from(const Interval& range) {
  constexpr double kTurn = std::numbers::pi;
  return {std::max(range.lb, -kTurn), std::min(range.ub, kTurn)};
}

}  // namespace

std::string_view to_string(StartKind kind) {
  constexpr std::array<std::string_view, kStartKinds> kNames = {
      "inside",        "on limits",       "beyond limits", "pushed out", "singular",
      "near singular", "singular beyond", "beyond box",    "near parts"};
  return kNames[static_cast<std::size_t>(kind)];
}

StartDraw::StartDraw(const config::Scenario& arm, std::uint64_t seed)
    : arm_(arm),
      random_(seed),
      chain_(arm.device.model.chain),
      parts_(arm.device.collision.shapes, arm.device.collision.pairs.watched),
      scenario_(arm) {}

double StartDraw::sample_size() {
  return kSmallest * std::pow(kLargest / kSmallest, random_.next());
}

double StartDraw::smallest_singular(const Eigen::VectorXd& q) {
  chain_.update_kinematics(q, Eigen::VectorXd::Zero(q.size()));
  const int n_m = scenario_.device.model.n_m;
  Eigen::MatrixXd J = chain_.jacobian(scenario_.device.model.handle).rightCols(n_m);
  J.bottomRows(3) *= kLength;
  return Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues()[5];
}

double StartDraw::distance(const Eigen::VectorXd& q) {
  chain_.update_poses(q);
  return parts_.distance(chain_);
}

// The joints' ranges of the URDF: files keep arms from singular postures.
void StartDraw::widen_limits() {
  DeviceModel& device = scenario_.device.model;
  for (int i = device.n_p; i < device.n_p + device.n_m; ++i) {
    const Interval whole = device.chain.joints()[static_cast<std::size_t>(i)].position;
    limits_of(device, i).q_min = whole.lb;
    limits_of(device, i).q_max = whole.ub;
  }
}

Eigen::VectorXd StartDraw::inside() {
  const DeviceModel& device = scenario_.device.model;
  Eigen::VectorXd q(device.n_p + device.n_m);
  for (int i = 0; i < q.size(); ++i) {
    const Interval range = to_draw_from(range_of(device, i));
    const double edge = 0.05 * (range.ub - range.lb);
    q[i] = random_.between(range.lb + edge, range.ub - edge);
  }
  return q;
}

// One joint after the other to where the smallest singular value is least.
bool StartDraw::go_to_singular(Eigen::VectorXd& q) {
  const DeviceModel& device = scenario_.device.model;
  constexpr int kSteps = 60, kRounds = 12;
  const int first = static_cast<int>(random_.next() * device.n_m);
  for (int round = 0; round < kRounds; ++round) {
    const int i = device.n_p + (first + round) % device.n_m;
    const Interval range = to_draw_from(range_of(device, i));
    double width = range.ub - range.lb, middle = 0.5 * (range.ub + range.lb);
    for (double steps = kSteps; width > 1e-9; steps = 10) {
      double best = kInfinity, at = middle;
      for (int k = 0; k <= static_cast<int>(steps); ++k) {
        q[i] = std::clamp(middle + width * (k / steps - 0.5), range.lb, range.ub);
        const double s = smallest_singular(q);
        if (s < best) best = s, at = q[i];
      }
      middle = at;
      width *= 2.0 / steps;
    }
    q[i] = middle;
    if (smallest_singular(q) < 1e-7) return true;
  }
  return false;
}

bool StartDraw::place_at_limits(StartKind kind, Eigen::VectorXd& q) {
  const DeviceModel& device = scenario_.device.model;
  std::vector<int> bounded;
  for (int i = 0; i < q.size(); ++i) {
    const Interval range = range_of(device, i);
    if (std::isfinite(range.lb) && std::isfinite(range.ub)) bounded.push_back(i);
  }
  if (bounded.empty()) return false;
  const int count = 1 + static_cast<int>(random_.next() * 3);
  for (int k = 0; k < count && !bounded.empty(); ++k) {
    const auto which =
        static_cast<std::ptrdiff_t>(random_.next() * static_cast<double>(bounded.size()));
    const int i = bounded[static_cast<std::size_t>(which)];
    bounded.erase(bounded.begin() + which);
    const double side = random_.next() < 0.5 ? -1.0 : 1.0;
    double beyond = 0.0;
    if (kind == StartKind::kBeyondLimits) beyond = sample_size();
    if (kind == StartKind::kPushedOut) beyond = -random_.between(0.0, 1e-2);
    q[i] = (side > 0.0 ? range_of(device, i).ub : range_of(device, i).lb) + side * beyond;
    place_ += fmt::format(" {}{}{:+.2g}", device.chain.joints()[static_cast<std::size_t>(i)].name,
                          side > 0.0 ? " max" : " min", beyond);
    if (i >= device.n_p) rows_.push_back({-side * Eigen::VectorXd::Unit(q.size(), i)});
  }
  return true;
}

// A joint's end where the joint is, or so much behind it.
void StartDraw::fit_limit(Eigen::VectorXd& q) {
  DeviceModel& device = scenario_.device.model;
  const int i = device.n_p + static_cast<int>(random_.next() * device.n_m);
  const double side = random_.next() < 0.5 ? -1.0 : 1.0;
  const double beyond = random_.next() < 0.3 ? 0.0 : sample_size();
  limits::JointLimits& limits = limits_of(device, i);
  (side > 0.0 ? limits.q_max : limits.q_min) = q[i] - side * beyond;
  if (limits.q_max - limits.q_min < 1.0) {
    (side > 0.0 ? limits.q_min : limits.q_max) = q[i] - side * (beyond + 1.0);
  }
  place_ += fmt::format(" {} beyond {:.2g}", device.manipulator_joint(i - device.n_p), beyond);
  rows_.push_back({-side * Eigen::VectorXd::Unit(q.size(), i)});
}

// One to three faces of the box of a frame where the frame is, or so much behind it.
void StartDraw::fit_box(const Eigen::VectorXd& q) {
  DeviceModel& device = scenario_.device.model;
  CartesianLimit& box = device.cartesian_limits.front();
  chain_.update_kinematics(q, Eigen::VectorXd::Zero(q.size()));
  const Eigen::Vector3d p = chain_.pose(box.frame).p;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0 && random_.next() < 0.6) continue;
    const double side = random_.next() < 0.5 ? -1.0 : 1.0;
    const double beyond = random_.next() < 0.3 ? 0.0 : sample_size();
    limits::JointLimits& limits = box.axes[static_cast<std::size_t>(axis)];
    (side > 0.0 ? limits.q_max : limits.q_min) = p[axis] - side * beyond;
    place_ += fmt::format(" {} {:+.0f} beyond {:.2g}", "xyz"[axis], side, beyond);
    rows_.push_back({-side * chain_.jacobian(box.frame).row(axis).transpose()});
  }
}

// From a clear posture towards another one until parts are nearer than the safe distance.
bool StartDraw::go_near_parts(Eigen::VectorXd& q) {
  const double safe = scenario_.device.collision.safe_distance;
  const double wanted = safe - std::min(sample_size(), 0.9 * safe);
  const Eigen::VectorXd from = q, to = inside();
  double clear = 0.0, near = -1.0;
  for (double share = 0.02; share < 1.0 && near < 0.0; share += 0.02) {
    (distance(from + share * (to - from)) > wanted ? clear : near) = share;
  }
  if (near < 0.0) return false;
  for (int k = 0; k < 50; ++k) {
    const double middle = 0.5 * (clear + near);
    (distance(from + middle * (to - from)) > wanted ? clear : near) = middle;
  }
  q = from + clear * (to - from);
  if (distance(q) > safe) return false;
  place_ += fmt::format(" parts {:.2g} too near", safe - distance(q));
  return true;
}

bool StartDraw::is_permitted(StartKind kind, const Eigen::VectorXd& q) {
  const DeviceModel& device = scenario_.device.model;
  const auto q_m = q.tail(device.n_m);
  for (const VirtualJoint& joint : device.virtual_joints) {
    const double sum = joint.weights.dot(q_m);
    if (sum < joint.limits.q_min || sum > joint.limits.q_max) return false;
  }
  if (kind != StartKind::kNearParts) {
    return distance(q) > scenario_.device.collision.safe_distance + kClear;
  }
  return distance(q) > 0.0;
}

// Also away from the ends of joints, the safe distance and the sums' ends that are near by chance.
bool StartDraw::keep_away(const Eigen::VectorXd& q) {
  const DeviceModel& device = scenario_.device.model;
  constexpr double kNear = 0.05, kNearPart = 0.01;  // rad or m, m
  constexpr double kStep = 1e-5;                    // rad or m
  for (int i = device.n_p; i < q.size(); ++i) {
    const Interval range = range_of(device, i);
    if (q[i] - range.lb < kNear) rows_.push_back({Eigen::VectorXd::Unit(q.size(), i)});
    if (range.ub - q[i] < kNear) rows_.push_back({-Eigen::VectorXd::Unit(q.size(), i)});
  }
  const double safe = scenario_.device.collision.safe_distance, now = distance(q);
  if (now > safe + kNearPart) return true;
  Eigen::VectorXd slope(q.size());
  for (int i = 0; i < q.size(); ++i) {
    slope[i] = (distance(q + kStep * Eigen::VectorXd::Unit(q.size(), i)) - now) / kStep;
  }
  if (slope.norm() < 1e-3) return now > safe;  // at such a distance in every posture
  rows_.push_back({slope});
  return true;
}

std::optional<Vector6> StartDraw::push_out(const Eigen::VectorXd& q) {
  const DeviceModel& device = scenario_.device.model;
  chain_.update_kinematics(q, Eigen::VectorXd::Zero(q.size()));
  const model::Jacobian J = chain_.jacobian(device.handle);
  Vector6 mass;
  mass << Eigen::Vector3d::Constant(kTwinMass), Eigen::Vector3d::Constant(kTwinInertia);
  constexpr int kTries = 300;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    Eigen::VectorXd dq = Eigen::VectorXd::Zero(q.size());
    for (int i = device.n_p; i < q.size(); ++i) dq[i] = random_.between(-1.0, 1.0);
    // rows that are missed are turned round
    for (const Row& row : rows_) {
      const double speed = row.gradient.dot(dq);
      if (speed < 0.0) dq -= 2.0 * speed / row.gradient.squaredNorm() * row.gradient;
    }
    dq.head(device.n_p).setZero();
    const bool leads_out = std::ranges::all_of(rows_, [&](const Row& row) {
      return row.gradient.dot(dq) > 0.1 * row.gradient.norm() * dq.norm();
    });
    if (!leads_out) continue;
    const Vector6 v = J * dq;
    const double speed = v.head<3>().norm(), turn = v.tail<3>().norm();
    double k = std::min(kForce / (kTwinMass * speed), kTorque / (kTwinInertia * turn));
    for (int i = 0; i < device.n_m; ++i) {
      const double rating = device.joint_limits[static_cast<std::size_t>(i)].ddq_max;
      k = std::min(k, kOfRating * rating / std::abs(dq[device.n_p + i]));
    }
    for (const CartesianLimit& box : device.cartesian_limits) {
      const double fast = (chain_.jacobian(box.frame) * dq).head<3>().norm();
      k = std::min(k, kOfRating * box.axes[0].ddq_max / fast);
    }
    if (k * std::hypot(speed, kLength * turn) < kAcceleration) continue;
    return Vector6(k * mass.cwiseProduct(v));
  }
  return {};
}

std::optional<DrawnStart> StartDraw::attempt(StartKind kind) {
  scenario_ = arm_;
  rows_.clear();
  place_.clear();
  DeviceModel& device = scenario_.device.model;
  for (CartesianLimit& box : device.cartesian_limits) {
    for (limits::JointLimits& axis : box.axes) axis.q_min = -kInRoom, axis.q_max = kInRoom;
  }
  const bool is_singular = kind == StartKind::kSingular || kind == StartKind::kNearSingular ||
                           kind == StartKind::kSingularBeyond;
  if (is_singular) widen_limits();
  Eigen::VectorXd q = inside();
  if (is_singular && !go_to_singular(q)) return {};
  if (kind == StartKind::kNearSingular) {
    Eigen::VectorXd way(q.size());
    for (double& part : way) part = random_.between(-1.0, 1.0);
    way.head(device.n_p).setZero();
    q += sample_size() / way.norm() * way;
  }
  const bool is_at_limits = kind == StartKind::kOnLimits || kind == StartKind::kBeyondLimits ||
                            kind == StartKind::kPushedOut;
  if (is_at_limits && !place_at_limits(kind, q)) return {};
  if (kind == StartKind::kSingularBeyond) fit_limit(q);
  if (kind == StartKind::kBeyondBox) {
    if (device.cartesian_limits.empty()) return {};
    fit_box(q);
  }
  if (kind == StartKind::kNearParts && !go_near_parts(q)) return {};
  if (!is_permitted(kind, q) || !keep_away(q)) return {};
  const std::optional<Vector6> push = push_out(q);
  if (!push) return {};
  DrawnStart drawn{.scenario = scenario_,
                   .start = {.T_B_H = {}, .q_p = q.head(device.n_p), .q_m = q.tail(device.n_m)},
                   .push = *push,
                   .is_pushed_out = kind == StartKind::kPushedOut,
                   .place = place_,
                   .smallest_singular = smallest_singular(q)};
  drawn.start.T_B_H = chain_.pose(device.handle);
  const Eigen::Quaterniond turn(drawn.start.T_B_H.R);
  drawn.scenario.twin.model.q_start << drawn.start.T_B_H.p, turn.coeffs();
  config::settle_law(drawn.scenario);
  return drawn;
}

std::optional<DrawnStart> StartDraw::draw(StartKind kind) {
  constexpr int kAttempts = 200;
  for (int k = 0; k < kAttempts; ++k) {
    if (auto drawn = attempt(kind)) return drawn;
  }
  return {};
}

}  // namespace hg
