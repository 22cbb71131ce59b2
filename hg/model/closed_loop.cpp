#include "hg/model/closed_loop.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include "hg/core/input_fault.h"
#include "hg/core/nearest_name.h"

namespace hg::model {
namespace {

constexpr int kPoints = 1025;      // of a curve
constexpr double kMeets = 1e-5;    // m
constexpr double kFastest = 50.0;  // of a joint, over the leader
constexpr int kNewtonSteps = 50;
constexpr double kConverged = 1e-13;  // rad or m, of a step

using Values = Eigen::VectorXd;

template <typename Items>
int index_of(const Items& items, const std::string& name, const std::string& source,
             const std::string& what) {
  std::vector<std::string> names;
  for (const auto& item : items) {
    if (item.name == name) return static_cast<int>(names.size());
    names.push_back(item.name);
  }
  throw InputError(InputFault{.file = source,
                              .what = what + " must be one of the URDF, got '" + name +
                                      "', nearest is '" + nearest_name(name, names) + "'"});
}

Pose motion_of(const UrdfJoint& joint, double q) {
  if (joint.type == UrdfJointType::kPrismatic) return {q * joint.axis, Eigen::Matrix3d::Identity()};
  return {Eigen::Vector3d::Zero(), Eigen::AngleAxisd(q, joint.axis).toRotationMatrix()};
}

// The joints of a loop: the leader first, then those that follow.
class Linkage {
 public:
  Linkage(const Urdf& urdf, const ClosedLoop& loop)
      : urdf_(urdf),
        loop_(loop),
        link_(index_of(urdf.links, loop.link, urdf.source, "a link of a loop")),
        meets_(index_of(urdf.links, loop.meets, urdf.source, "a link of a loop")) {
    add(loop.leader);
    for (const std::string& name : loop.follow) add(name);
    if (followers() < 1 || followers() > 3) {
      fail("one to three joints follow, got " + std::to_string(followers()));
    }
  }

  const UrdfJoint& joint(int i) const { return urdf_.joints[joints_[i]]; }
  int followers() const { return static_cast<int>(joints_.size()) - 1; }

  // Values of the joints that follow for a position of the leader, from a guess.
  Values solved(double leader, Values guess) const {
    for (int step = 0; step < kNewtonSteps; ++step) {
      const Values change = jacobian(leader, guess)
                                .rightCols(followers())
                                .colPivHouseholderQr()
                                .solve(gap(leader, guess));
      guess -= change;
      if (change.norm() < kConverged) break;
    }
    const double distance = gap(leader, guess).norm();
    if (!(distance < kMeets)) {
      fail("is open by " + to_text(std::round(1e4 * distance) / 10.0) + " mm at " + place(leader) +
           "; narrow the range of that joint, or mend the URDF");
    }
    return guess;
  }

  // Speeds of these joints over that of the leader.
  Values slopes(double leader, const Values& values) const {
    const Eigen::MatrixXd J = jacobian(leader, values);
    const Values slopes = -J.rightCols(followers()).colPivHouseholderQr().solve(J.col(0));
    if (!slopes.allFinite() || slopes.cwiseAbs().maxCoeff() > kFastest) {
      fail("is near a dead centre at " + place(leader) + "; narrow the range of that joint");
    }
    return slopes;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(InputFault{
        .file = urdf_.source, .item = "loop " + loop_.link + " - " + loop_.meets, .what = what});
  }

 private:
  void add(const std::string& name) {
    joints_.push_back(index_of(urdf_.joints, name, urdf_.source, "a joint of a loop"));
    const UrdfJointType type = urdf_.joints[joints_.back()].type;
    if (type != UrdfJointType::kRevolute && type != UrdfJointType::kContinuous &&
        type != UrdfJointType::kPrismatic) {
      fail("joint " + name + " must turn or slide");
    }
    if (std::ranges::count(joints_, joints_.back()) > 1) fail("joint " + name + " is named twice");
  }

  std::string place(double leader) const {
    return loop_.leader + " = " + to_text(std::round(1e4 * leader) / 1e4);
  }

  Pose pose(int link, double leader, const Values& values) const {
    Pose pose;
    for (std::size_t depth = 0; depth < urdf_.joints.size(); ++depth) {
      const auto carrier = std::ranges::find(urdf_.joints, link, &UrdfJoint::child);
      if (carrier == urdf_.joints.end()) break;
      const auto at = std::ranges::find(joints_, static_cast<int>(carrier - urdf_.joints.begin()));
      const auto i = at - joints_.begin();
      const double q = at == joints_.end() ? 0.0 : i == 0 ? leader : values[i - 1];
      pose = carrier->T_parent_joint * motion_of(*carrier, q) * pose;
      link = carrier->parent;
    }
    return pose;
  }

  Eigen::Vector3d gap(double leader, const Values& values) const {
    return pose(link_, leader, values).p - pose(meets_, leader, values).p;
  }

  // Of the gap, by the leader and by the others.
  Eigen::MatrixXd jacobian(double leader, const Values& values) const {
    constexpr double kStep = 1e-6;
    Eigen::MatrixXd J(3, followers() + 1);
    J.col(0) = (gap(leader + kStep, values) - gap(leader - kStep, values)) / (2.0 * kStep);
    for (int i = 0; i < followers(); ++i) {
      const Values step = kStep * Values::Unit(followers(), i);
      J.col(i + 1) = (gap(leader, values + step) - gap(leader, values - step)) / (2.0 * kStep);
    }
    return J;
  }

  const Urdf& urdf_;
  const ClosedLoop& loop_;
  int link_, meets_;
  std::vector<int> joints_;
};

// Range of the leader; a turn where it has no end.
Interval range_of(const Linkage& linkage) {
  const UrdfJoint& leader = linkage.joint(0);
  if (leader.type == UrdfJointType::kContinuous) return {-M_PI, M_PI};
  return leader.position;
}

// Rows: values of the joints that follow at equal distances over the range of the leader.
Eigen::MatrixXd solve_all(const Linkage& linkage, const Interval& range) {
  const double step = (range.ub - range.lb) / (kPoints - 1);
  const auto leader = [&](int i) { return range.lb + i * step; };
  const int start =
      static_cast<int>(std::lround((std::clamp(0.0, range.lb, range.ub) - range.lb) / step));
  Eigen::MatrixXd values(linkage.followers(), kPoints);
  values.col(start) = linkage.solved(leader(start), Values::Zero(linkage.followers()));
  const auto go = [&](int i, int before) {
    const Values last = values.col(before);
    values.col(i) = linkage.solved(
        leader(i), last + (leader(i) - leader(before)) * linkage.slopes(leader(before), last));
  };
  for (int i = start + 1; i < kPoints; ++i) go(i, i - 1);
  for (int i = start - 1; i >= 0; --i) go(i, i + 1);
  return values;
}

// No joint that follows leaves its own range within that of the leader.
void require_limits(const Linkage& linkage, const Interval& range, const Eigen::MatrixXd& values) {
  for (int i = 0; i < linkage.followers(); ++i) {
    const UrdfJoint& joint = linkage.joint(i + 1);
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      if (joint.position.contains(values(i, k))) continue;
      const double leader =
          range.lb + static_cast<double>(k) * (range.ub - range.lb) / (kPoints - 1);
      linkage.fail("joint " + joint.name + " would be at " + to_text(values(i, k)) +
                   ", beyond its limits, where " + linkage.joint(0).name + " is at " +
                   to_text(leader));
    }
  }
}

}  // namespace

std::vector<Coupling> close_loop(const Urdf& urdf, const ClosedLoop& loop) {
  const Linkage linkage(urdf, loop);
  const Interval range = range_of(linkage);
  const bool turns = linkage.joint(0).type == UrdfJointType::kContinuous;
  const Eigen::MatrixXd values = solve_all(linkage, range);
  require_limits(linkage, range, values);
  const Values first = linkage.slopes(range.lb, values.col(0));
  const Values last = linkage.slopes(range.ub, values.col(kPoints - 1));
  std::vector<Coupling> couplings;
  for (int i = 0; i < linkage.followers(); ++i) {
    std::vector<double> points(kPoints);
    Eigen::VectorXd::Map(points.data(), kPoints) = values.row(i);
    const double turned = (points.back() - points.front()) / (2.0 * M_PI);
    if (turns && std::abs(turned - std::round(turned)) > 1e-6) {
      linkage.fail("is another one after a turn of " + loop.leader);
    }
    couplings.push_back({.joint = loop.follow[static_cast<std::size_t>(i)],
                         .leader = loop.leader,
                         .curve = std::make_shared<CouplingCurve>(range, std::move(points),
                                                                  first[i], last[i], turns)});
  }
  return couplings;
}

}  // namespace hg::model
