#include "hg/experiments/place.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/error.h"
#include "hg/experiments/changes.h"
#include "hg/model/chain_data.h"
#include "hg/workspace/postures.h"
#include "hg/workspace/survey.h"

namespace hg::experiments {
namespace {

constexpr double kStep = 0.02;      // m, of straight ways
constexpr double kFarthest = 0.75;  // m, to either side
constexpr double kLeast = 0.02;     // m, half an edge of the smallest box

// Postures of a device that measurements may use.
class Reach {
 public:
  explicit Reach(const config::DeviceConfig& device)
      : device_(device),
        ranges_(workspace::joint_ranges(device)),
        chain_(device.model.chain),
        shapes_(device.collision.shapes, device.collision.pairs.watched) {}

  const workspace::JointRanges& ranges() const { return ranges_; }
  Pose handle(const Eigen::VectorXd& q) {
    chain_.update_poses(q);
    return chain_.pose(device_.model.handle);
  }
  double dexterity(const Eigen::VectorXd& q) {
    return workspace::dexterity(chain_, device_.model.handle, 0, q);
  }

  // Whether there is a margin to all limits, singular postures and collisions.
  bool permits(const Eigen::VectorXd& q) {
    constexpr double kMargin = 0.05;     // of a range
    constexpr double kDexterous = 0.03;  // m/rad
    const Eigen::ArrayXd margin = kMargin * (ranges_.upper - ranges_.lower).array();
    if ((q.array() < ranges_.lower.array() + margin).any()) return false;
    if ((q.array() > ranges_.upper.array() - margin).any()) return false;
    if (!workspace::permits_virtual_joints(device_.model, q)) return false;
    if (dexterity(q) < kDexterous) return false;  // moves the chain
    if (!workspace::permits_boxes(device_.model, chain_)) return false;
    const double apart = device_.collision.safe_distance;
    if (device_.has_floor && chain_.pose(device_.model.handle).p.z() < device_.floor_z + apart)
      return false;
    return shapes_.distance(chain_) >= apart;
  }

  // The posture that joints to spare are drawn to, as by the control law.
  void set_goal(const Eigen::VectorXd& q) { goal_ = q; }

  // Moves `q` to the near posture with the handle at `T_B_H`; false where there is none.
  bool follow(const Pose& T_B_H, Eigen::VectorXd& q) {
    constexpr int kSteps = 12;
    constexpr double kDrawn = 0.5;  // of the way to the goal, per step
    constexpr double kReached = 1e-5, kDamping = 1e-6;
    const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(q.size());
    for (int i = 0; i < kSteps; ++i) {
      chain_.update_kinematics(q, at_rest);
      const Pose now = chain_.pose(device_.model.handle);
      const Eigen::AngleAxisd turn(T_B_H.R * now.R.transpose());
      Vector6 error;
      error << T_B_H.p - now.p, turn.angle() * turn.axis();
      if (error.norm() < kReached) return permits(q);
      const Eigen::MatrixXd J = chain_.jacobian(device_.model.handle);
      const Eigen::MatrixXd damped = J * J.transpose() + kDamping * Eigen::MatrixXd::Identity(6, 6);
      Eigen::VectorXd free = Eigen::VectorXd::Zero(q.size());
      if (q.size() > 6) free = kDrawn * (goal_ - q);
      q += free + J.transpose() * damped.ldlt().solve(error - J * free);
    }
    return false;
  }

  // Length of the straight way from the pose of `q` along `way` (m) that can be followed, m.
  double lead(const Eigen::VectorXd& q, const Eigen::Vector3d& way) {
    const Pose start = handle(q);
    Eigen::VectorXd now = q;
    const double length = way.norm();
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kStep)));
    for (int i = 1; i <= steps; ++i) {
      if (!follow({.p = start.p + way * i / steps, .R = start.R}, now)) {
        return length * (i - 1) / steps;
      }
    }
    end_ = now;
    return length;
  }
  // The posture in which the last whole way has ended.
  const Eigen::VectorXd& end() const { return end_; }

  // Whether the handle can turn about the vertical by `angle` to both sides.
  bool turns(const Eigen::VectorXd& q, double angle) {
    constexpr int kParts = 6;
    const Pose start = handle(q);
    for (const double side : {-1.0, 1.0}) {
      Eigen::VectorXd now = q;
      for (int i = 1; i <= kParts; ++i) {
        const Eigen::AngleAxisd turn(side * angle * i / kParts, Eigen::Vector3d::UnitZ());
        if (!follow({.p = start.p, .R = turn * start.R}, now)) return false;
      }
    }
    return true;
  }

 private:
  const config::DeviceConfig& device_;
  workspace::JointRanges ranges_;
  model::ChainData chain_;
  const collision::Nearest shapes_;
  Eigen::VectorXd end_, goal_;
};

// Half the edges of the box around the pose of `q`, before its corners are tried; the pose moves to
// the middle of what is reached.
std::optional<Eigen::Vector3d> spread(Reach& reach, Eigen::VectorXd& q) {
  Eigen::Vector3d half;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d e = Eigen::Vector3d::Unit(axis);
    const double up = reach.lead(q, kFarthest * e), down = reach.lead(q, -kFarthest * e);
    half[axis] = 0.5 * (up + down);
    const Eigen::Vector3d to_middle = 0.5 * (up - down) * e;
    if (half[axis] < kLeast || reach.lead(q, to_middle) < to_middle.norm()) return {};
    if (to_middle.norm() > 0.0) q = reach.end();
  }
  return half;
}

bool reaches_corners(Reach& reach, const Eigen::VectorXd& q, const Eigen::Vector3d& half,
                     double turn) {
  if (!reach.turns(q, turn)) return false;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const Eigen::Vector3d way = half.cwiseProduct(sides);
    if (reach.lead(q, way) < way.norm() || !reach.turns(reach.end(), turn)) return false;
  }
  return true;
}

// The largest box around a posture that the handle can be led through.
// `keeps_goal`: joints to spare are drawn to `q`, not to the posture in the middle of the box.
std::optional<Place> box_around(Reach& reach, Eigen::VectorXd q, int n_m, bool keeps_goal) {
  constexpr double kTurn = 0.3;      // rad
  constexpr double kSmaller = 0.85;  // per try
  if (!reach.permits(q)) return {};
  reach.set_goal(q);
  std::optional<Eigen::Vector3d> half = spread(reach, q);
  if (!half) return {};
  if (!keeps_goal) reach.set_goal(q);
  while (!reaches_corners(reach, q, *half, kTurn)) {
    *half *= kSmaller;
    if (half->minCoeff() < kLeast) return {};
  }
  const Pose middle = reach.handle(q);
  return Place{.middle = middle.p,
               .lower = middle.p - *half,
               .upper = middle.p + *half,
               .turn = kTurn,
               .is_found = true,
               .R_B_H = middle.R,
               .posture = q.tail(n_m)};
}

double smallest_edge(const Place& place) { return (place.upper - place.lower).minCoeff(); }

// The device's posture, the gantry in the middle of its travel; empty without a whole one.
std::optional<Eigen::VectorXd> own_posture(const DeviceModel& model,
                                           const workspace::JointRanges& ranges) {
  if (model.posture.size() == 0 || model.posture.hasNaN()) return {};
  Eigen::VectorXd q = 0.5 * (ranges.lower + ranges.upper);
  q.tail(model.n_m) = model.posture;
  return q;
}

// The most dexterous of random postures, best first.
std::vector<Eigen::VectorXd> dexterous_postures(const config::DeviceConfig& device, Reach& reach) {
  constexpr int kDrawn = 3000;
  constexpr std::size_t kKept = 40;
  Random random(1);
  std::vector<std::pair<double, Eigen::VectorXd>> found;
  for (int i = 0; i < kDrawn; ++i) {
    const auto q = workspace::draw(device, reach.ranges(), false, random);
    if (!q) break;
    if (reach.permits(*q)) found.emplace_back(reach.dexterity(*q), *q);
  }
  std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Eigen::VectorXd> best;
  for (auto& [dexterity, q] : found) {
    if (best.size() == kKept) break;
    best.push_back(std::move(q));
  }
  return best;
}

}  // namespace

Place place_of(const config::DeviceConfig& device) {
  constexpr double kEnough = 0.24;  // m: strokes of 0.2 m fit
  if (device.model.has_closed_form) return {};
  Reach reach(device);
  Place best;
  const auto take = [&](const std::optional<Place>& found) {
    if (found && (!best.is_found || smallest_edge(*found) > smallest_edge(best))) best = *found;
  };
  const int n_m = device.model.n_m;
  if (const auto q = own_posture(device.model, reach.ranges()))
    take(box_around(reach, *q, n_m, true));
  if (best.is_found && smallest_edge(best) >= kEnough) {
    best.posture.resize(0);
    return best;
  }
  for (const Eigen::VectorXd& q : dexterous_postures(device, reach)) {
    take(box_around(reach, q, n_m, false));
  }
  if (best.is_found) return best;
  throw SetupError(fmt::format(
      "{}: no box of {:g} cm was found in which the handle can be led in one orientation, apart "
      "from limits, singular postures and collisions; look at `hapticgiant check` of the device",
      device.name, 200.0 * kLeast));
}

config::Scenario at_place(config::Scenario scenario, const Place& place) {
  if (!place.is_found) return scenario;
  scenario.twin.T_B_root = {};
  set_free_twin(scenario, free_twin_of(scenario));
  const Eigen::Quaterniond turn(place.R_B_H);
  scenario.twin.model.q_start << place.middle, turn.coeffs();
  if (place.posture.size() > 0) scenario.device.model.posture = place.posture;
  scenario.events.clear();
  scenario.changes.clear();
  return scenario;
}

std::string no_room(const Place& place, const Eigen::Vector3d& direction, double length) {
  if (!place.is_found) return "";
  const Eigen::Vector3d half = 0.5 * (place.upper - place.lower);
  double room = kFarthest;  // to either side
  for (int axis = 0; axis < 3; ++axis) {
    const double share = std::abs(direction[axis]);
    if (share > 1e-9) room = std::min(room, half[axis] / share);
  }
  if (0.5 * length <= room) return "";
  return fmt::format("{}the handle needs {:.2f} m, the device has {:.2f} m there", kNotPossible,
                     length, 2.0 * room);
}

std::string to_text(const Place& place) {
  if (!place.is_found) return "";
  const Eigen::Vector3d edges = place.upper - place.lower;
  return fmt::format(
      "Measured around ({:.2f}, {:.2f}, {:.2f}) m in the base frame of the device; strokes through "
      "its workspace end in a box of {:.2f} x {:.2f} x {:.2f} m there and turn the handle by up to "
      "{:g} rad: the largest box found in which it can be led in one orientation.",
      place.middle.x(), place.middle.y(), place.middle.z(), edges.x(), edges.y(), edges.z(),
      place.turn);
}

}  // namespace hg::experiments
