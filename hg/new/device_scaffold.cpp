#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/config/actuator_library.h"
#include "hg/config/shipped_files.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/new/drives.h"
#include "hg/new/scaffold.h"
#include "hg/new/self_collision.h"
#include "hg/workspace/postures.h"

namespace hg::new_files {
namespace {

constexpr int kPostures = 2000;
constexpr double kTableHeight = 0.75;    // m, of what a standing arm stands on
constexpr double kTable = 0.05;          // m, handles stay above the plane of the root link by it
constexpr double kClear = 0.1;           // m, desired between parts of the arm in its posture
constexpr double kEnough = 0.6;          // share of that; with less a run might end where it begins
constexpr double kSingularMargin = 0.2;  // rad, kept from a singular value
constexpr double kRampTime = 0.2;        // s, from rest to full speed where no rating is known
constexpr double kDefaultSpeed = 1.5;    // rad/s or m/s where the URDF has none

struct DeviceDraft {
  model::ChainData chain;
  int n_p = 0;
  int handle = 0;
  bool stands = false;
  std::vector<Interval> ranges;  ///< sampled and written: the URDF's without singular values
  std::vector<workspace::SingularValue> singular;
  Eigen::VectorXd posture;
  SelfCollision shapes;
};

const model::Joint& joint(const DeviceDraft& d, int i) { return d.chain.model().joints()[i]; }

// leading prismatic joints that six or seven others follow
int gantry_joints(const model::ChainModel& chain, const std::string& source) {
  const int n = chain.nv();
  int leading = 0;
  for (const model::Joint& joint : chain.joints()) {
    if (joint.nv != 1)
      throw SetupError(source + ": joint " + joint.name + ": a device has no floating joints");
    if (!joint.is_slide()) break;
    ++leading;
  }
  const int n_p = std::min({leading, kMaxGantry, n - 6});
  if (n_p < 0 || n - n_p > kMaxManipulator) {
    throw SetupError(fmt::format(
        "{}: a device needs six or seven manipulator joints, and at most two gantry joints before "
        "them, got {} joints of which the first {} are prismatic; take a part of the URDF with "
        "--root-link and --tip-link",
        source, n, leading));
  }
  return n_p;
}

// speeds and accelerations as they are written down
double speed_of(const model::Joint& joint) {
  return std::isfinite(joint.velocity_max) ? joint.velocity_max : kDefaultSpeed;
}
double acceleration_of(const model::Joint& joint) {
  return std::stod(rounded(speed_of(joint) / kRampTime));
}

std::string unit_of(const model::Joint& joint) { return joint.is_slide() ? "m" : "rad"; }

// the handle of a standing arm is above the plane that it stands on
bool is_usable(const DeviceDraft& d) { return !d.stands || d.chain.pose(d.handle).p.z() >= kTable; }

// a gantry hangs; an arm stands unless it reaches little above its root
bool stands(DeviceDraft& d) {
  workspace::PostureSampler sampler(d.ranges);
  int above = 0;
  for (int k = 0; k < kPostures; ++k) {
    d.chain.update_kinematics(sampler.draw(), Eigen::VectorXd::Zero(d.chain.model().nv()));
    if (d.chain.pose(d.handle).p.z() >= kTable) ++above;
  }
  return d.n_p == 0 && above > kPostures / 4;
}

// How far the parts of an arm are apart in a posture, compared with how far they can be.
class Clearances {
 public:
  explicit Clearances(DeviceDraft& d) {
    constexpr int kSamples = 200;
    workspace::PostureSampler sampler(d.ranges);
    for (const collision::Pair& pair : d.shapes.pairs.watched) {
      pairs_.push_back({collision::Nearest(d.shapes.shapes, {pair}), 0.0});
    }
    for (int k = 0; k < kSamples; ++k) {
      d.chain.update_poses(sampler.draw());
      for (Apart& pair : pairs_) pair.most = std::max(pair.most, pair.nearest.distance(d.chain));
    }
    std::erase_if(pairs_, [](const Apart& pair) { return pair.most <= 0.0; });  // always touch
  }

  // What a posture is worth: 1 where each pair has kClear, or kMost of its largest distance;
  // kTouching where one has less than kEnough of that.
  double worth(const model::ChainData& chain) const {
    constexpr double kMost = 0.8, kTouching = 1e-3;
    double share = 1.0;
    for (const Apart& pair : pairs_) {
      const double wanted = std::min(kClear, kMost * pair.most);
      share = std::min(share, pair.nearest.distance(chain) / wanted);
    }
    return share < kEnough ? kTouching : share;
  }

 private:
  struct Apart {
    collision::Nearest nearest;
    double most;  // distance
  };
  std::vector<Apart> pairs_;
};

// `q` with the two digits that are written down: rounding moves parts of an arm by centimetres
Eigen::VectorXd as_written(const Eigen::VectorXd& q) {
  return q.unaryExpr([](double value) { return std::stod(rounded(value)); });
}

// The most dexterous of many postures, not too near to the ends of the joints, with clear parts and
// the gantry in its middle.
Eigen::VectorXd best_posture(DeviceDraft& d) {
  workspace::PostureSampler sampler(d.ranges);
  const Clearances clearances(d);
  const auto draw = [&] {
    Eigen::VectorXd q = as_written(sampler.draw());
    for (int i = 0; i < d.n_p; ++i) q[i] = 0.5 * (d.ranges[i].lb + d.ranges[i].ub);
    return q;
  };
  Eigen::VectorXd best = draw();
  double most = -1.0;
  for (int k = 0; k < kPostures; ++k) {
    const Eigen::VectorXd q = draw();
    double nearest = 1.0, sum = 0.0;  // 1 in the middle of a range, 0 at its ends
    for (int i = d.n_p; i < q.size(); ++i) {
      const Interval range = d.ranges[i];
      const double share = (2.0 * q[i] - range.lb - range.ub) / (range.ub - range.lb);
      nearest = std::min(nearest, 1.0 - std::abs(share));
      sum += 1.0 - share * share;
    }
    double value = workspace::dexterity(d.chain, d.handle, d.n_p, q) * std::sqrt(nearest) * sum;
    if (value > most) value *= clearances.worth(d.chain);
    if (value > most && is_usable(d)) {
      most = value;
      best = q;
    }
  }
  return best;
}

// part of `range` around `value` that stays away from `singular`
Interval without(Interval range, double singular, double value) {
  if (singular < value) {
    range.lb = std::max(range.lb, singular + kSingularMargin);
  } else {
    range.ub = std::min(range.ub, singular - kSingularMargin);
  }
  return range;
}

void leave_singularities(DeviceDraft& d) {
  for (const workspace::SingularValue& s : d.singular) {
    if (s.other >= 0) continue;
    Interval& range = d.ranges[s.joint];
    const Interval rest = without(range, s.value, d.posture[s.joint]);
    if (rest.contains(d.posture[s.joint])) range = rest;  // else too little would be left
  }
}

// sums that are singular, with the range that is left for each
std::vector<std::pair<workspace::SingularValue, Interval>> sums(const DeviceDraft& d) {
  std::vector<std::pair<workspace::SingularValue, Interval>> found;
  for (const workspace::SingularValue& s : d.singular) {
    if (s.other < 0) continue;
    const auto same = std::ranges::find_if(
        found, [&](const auto& entry) { return entry.first.joint == s.joint; });
    const Interval whole;
    Interval& range = same != found.end() ? same->second : found.emplace_back(s, whole).second;
    range = without(range, s.value, d.posture[s.joint] + d.posture[s.other]);
  }
  if (found.size() > kMaxVirtualJoints) found.resize(kMaxVirtualJoints);
  return found;
}

// capability of the manipulator at the handle in every direction of B at once, see `check`
struct Reach {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(kInfinity);
  Eigen::Vector3d upper = Eigen::Vector3d::Constant(-kInfinity);
  double speed = 1.5, acceleration = 5.0;
};

// What half of the joints' ratings give the handle along x, y, z in one posture.
struct Ability {
  Eigen::Vector3d p, speed = Eigen::Vector3d::Zero(), acceleration = Eigen::Vector3d::Zero();
};

std::vector<Ability> abilities(DeviceDraft& d) {
  workspace::PostureSampler sampler(d.ranges);
  std::vector<Ability> found;
  for (int k = 0; k < kPostures; ++k) {
    const Eigen::VectorXd q = sampler.draw();
    d.chain.update_kinematics(q, Eigen::VectorXd::Zero(q.size()));
    if (!is_usable(d)) continue;
    Ability ability = {.p = d.chain.pose(d.handle).p};
    const model::Jacobian J = d.chain.jacobian(d.handle);
    for (int i = d.n_p; i < q.size(); ++i) {
      const Eigen::Vector3d lever = 0.5 * J.col(i).head<3>().cwiseAbs();
      ability.speed += lever * speed_of(joint(d, i));
      ability.acceleration += lever * acceleration_of(joint(d, i));
    }
    found.push_back(ability);
  }
  return found;
}

// Such a share of the values is smaller; 0 without any.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::ranges::nth_element(values, values.begin() + at);
  return values[at];
}

Reach reach_of(DeviceDraft& d, const std::string& source) {
  constexpr double kFifth = 0.05;
  const std::vector<Ability> all = abilities(d);
  Reach reach;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> speeds, accelerations;
    for (const Ability& ability : all) {
      reach.lower[axis] = std::min(reach.lower[axis], ability.p[axis]);
      reach.upper[axis] = std::max(reach.upper[axis], ability.p[axis]);
      speeds.push_back(ability.speed[axis]);
      accelerations.push_back(ability.acceleration[axis]);
    }
    reach.speed = std::min(reach.speed, quantile(speeds, kFifth));
    reach.acceleration = std::min(reach.acceleration, quantile(accelerations, kFifth));
    if (reach.speed > 0.0) continue;
    throw SetupError(fmt::format(
        "{}: the joints hardly move '{}' along {}; a device needs an end that moves in all three "
        "directions: choose the arm with --root-link and --tip-link",
        source, d.chain.model().frame_names()[d.handle], "xyz"[axis]));
  }
  return reach;
}

std::string list_of(const DeviceDraft& d, int first, int end) {
  std::string text;
  for (int i = first; i < end; ++i) text += (i > first ? ", " : "") + quoted(joint(d, i).name);
  return "[" + text + "]";
}

std::string joint_lines(const DeviceDraft& d) {
  std::string text =
      "\njoints:  # positions and speeds that do not stand here are those of the URDF\n";
  for (int i = d.n_p; i < d.chain.model().nv(); ++i) {
    const model::Joint& j = joint(d, i);
    const Interval range = d.ranges[i];
    const std::string unit = unit_of(j);
    std::string keys, why = "full speed within 0.2 s";
    if (range.lb > j.position.lb && range.lb > -M_PI)
      keys += fmt::format("q_min_{}: {}, ", unit, rounded(range.lb));
    if (range.ub < j.position.ub && range.ub < M_PI)
      keys += fmt::format("q_max_{}: {}, ", unit, rounded(range.ub));
    if (!keys.empty()) why += "; [V] stays on one side of its singular position";
    if (!std::isfinite(j.velocity_max))
      keys += fmt::format("dq_max_{}_per_s: {}, ", unit, rounded(kDefaultSpeed));
    text += fmt::format("  {}: {{{}ddq_max_{}_per_s2: {}}}  # [A] {}\n", quoted(j.name), keys, unit,
                        rounded(acceleration_of(j)), why);
  }
  return text;
}

std::string posture_lines(const DeviceDraft& d) {
  std::string text = fmt::format(
      "\nposture:  # [V] the most dexterous of {} postures with clear parts; {}\n", kPostures,
      d.n_p > 0 ? "the gantry moves so that the arm stays near it"
                : "where runs begin, if they can");
  for (int i = d.n_p; i < d.chain.model().nv(); ++i) {
    text += fmt::format("  {}: {}\n", quoted(joint(d, i).name), rounded(d.posture[i]));
  }
  return text;
}

std::string virtual_joint_lines(const DeviceDraft& d) {
  const auto found = sums(d);
  if (found.empty()) return "";
  std::string text = "\nvirtual_joints:  # [V] sums of joints that are singular at one value\n";
  for (const auto& [sum, range] : found) {
    const model::Joint& a = joint(d, sum.joint);
    const model::Joint& b = joint(d, sum.other);
    text += fmt::format("  - name: {}\n    weights: {{{}: 1, {}: 1}}\n",
                        quoted(a.name + "+" + b.name), quoted(a.name), quoted(b.name));
    if (std::isfinite(range.lb)) text += fmt::format("    q_min_rad: {}\n", rounded(range.lb));
    if (std::isfinite(range.ub)) text += fmt::format("    q_max_rad: {}\n", rounded(range.ub));
    text += fmt::format("    dq_max_rad_per_s: {}  # [A]\n    ddq_max_rad_per_s2: {}  # [A]\n",
                        rounded(0.8 * (speed_of(a) + speed_of(b))),
                        rounded(0.5 * (acceleration_of(a) + acceleration_of(b))));
  }
  return text;
}

std::string box_lines(const DeviceDraft& d, const Reach& reach) {
  std::string text = fmt::format("\ncartesian_limits:\n  - name: hand\n    frame: {}\n",
                                 quoted(d.chain.model().frame_names()[d.handle]));
  for (int axis = 0; axis < 3; ++axis) {
    text +=
        fmt::format("    {}: {{q_min_m: {}, q_max_m: {}}}{}\n", "xyz"[axis],
                    rounded(reach.lower[axis]), rounded(reach.upper[axis]),
                    axis == 0 ? "  # [V] all that the arm reaches; make it smaller than your room"
                    : axis == 2 && d.stands ? "  # [A] above the plane that the arm stands on"
                                            : "");
  }
  text += fmt::format(
      "    dq_max_m_per_s: {}  # [V] half of what the joints give in 95 % of the postures\n",
      rounded(reach.speed));
  text += fmt::format("    ddq_max_m_per_s2: {}  # [V] the same\n", rounded(reach.acceleration));
  return text;
}

// the largest torques of all joints that weight, acceleration and a person need
Eigen::VectorXd needed_torques(DeviceDraft& d) {
  constexpr double kReserve = 1.5, kForce = 50.0, kTorque = 5.0;  // N, Nm: of a person
  Eigen::VectorXd most = Eigen::VectorXd::Zero(d.chain.model().nv());
  workspace::PostureSampler sampler(d.ranges);
  for (int k = 0; k < kPostures; ++k) {
    d.chain.update(sampler.draw(), Eigen::VectorXd::Zero(d.chain.model().nv()));
    for (int i = d.n_p; i < d.chain.model().nv(); ++i) {
      const Vector6 J = d.chain.jacobian(d.handle).col(i);
      const double torque = std::abs(d.chain.c()[i]) +
                            d.chain.M()(i, i) * acceleration_of(joint(d, i)) +
                            kForce * J.head<3>().norm() + kTorque * J.tail<3>().norm();
      most[i] = std::max(most[i], kReserve * torque);
    }
  }
  return most;
}

// the manipulator's joints with typical drives; none where a joint is prismatic: these all turn
std::vector<DrivenJoint> driven_joints(DeviceDraft& d) {
  const std::vector<model::Joint>& all = d.chain.model().joints();
  if (std::any_of(all.begin() + d.n_p, all.end(), [](const auto& j) { return j.is_slide(); })) {
    return {};
  }
  const auto library =
      config::load_actuator_library(config::models_root() / "models/actuators.yaml");
  const Eigen::VectorXd need = needed_torques(d);
  std::vector<DrivenJoint> joints;
  for (int i = d.n_p; i < d.chain.model().nv(); ++i) {
    const double effort = joint(d, i).effort_max;
    const double torque_max = std::isfinite(effort) ? effort : need[i];
    joints.push_back(
        {joint(d, i), config::actuator_for(library, torque_max, speed_of(joint(d, i)))});
  }
  return joints;
}

std::string drive_lines(const std::vector<DrivenJoint>& joints, Drives drives,
                        const std::string& simulation_file) {
  if (drives == Drives::kIdeal) return "";
  std::string text = fmt::format("simulation: {}  # how its simulation differs from this file\n",
                                 quoted(simulation_file));
  text += "\nestimation: {has_imu: false}  # [A] a force/torque sensor alone\n";
  if (drives == Drives::kPosition) return text;
  return text + "\nactuators:  # [A] typical joints of models/actuators.yaml\n" +
         actuator_lines(joints, "  ");
}

std::vector<std::string> doubts_of(const DeviceDraft& d, const Reach& reach) {
  constexpr double kFarthest = 30.0;  // m
  std::vector<std::string> doubts = doubts_of(d.shapes);
  const double extent = (reach.upper - reach.lower).maxCoeff();
  if (extent > kFarthest) {
    doubts.push_back(fmt::format(
        "the handle moves through {:.3g} m: are the lengths of the URDF millimetres? {:.3g} m",
        extent, 1e-3 * extent));
  }
  return doubts;
}

}  // namespace

DeviceFiles draft_device(const ChainPart& part, const std::filesystem::path& folder, Drives drives,
                         const std::string& simulation_file,
                         const std::function<void(std::size_t, std::size_t)>& progress) {
  DeviceDraft d{.chain = model::ChainData(read_part(part)),
                .ranges = {},
                .singular = {},
                .posture = {},
                .shapes = {}};
  d.n_p = gantry_joints(d.chain.model(), part.urdf.generic_string());
  d.handle = held_frame(d.chain.model(), d.chain.model().nv());
  if (d.handle < 0) {
    throw SetupError(part.urdf.generic_string() + ": no link is moved by all " +
                     std::to_string(d.chain.model().nv()) +
                     " joints, so that a hand could hold it");
  }
  d.ranges = workspace::joint_ranges(d.chain.model());
  for (std::size_t i = 0; i < d.ranges.size(); ++i) {
    // more than a turn says that the joint has no stops, only cables
    if (unit_of(d.chain.model().joints()[i]) == "rad")
      d.ranges[i] = intersect(d.ranges[i], {-M_PI, M_PI});
  }
  d.stands = stands(d);
  d.shapes = fit_self_collision(part, d.chain.model(), d.ranges,
                                d.stands ? std::optional(-kTableHeight) : std::nullopt, progress);
  d.singular = workspace::singular_values(d.chain.model(), d.handle, d.n_p, d.ranges);
  d.posture = best_posture(d);
  leave_singularities(d);
  const Reach reach = reach_of(d, part.urdf.generic_string());

  std::string text = fmt::format(
      "# {} as a device, from {}.\n"
      "# [V] worked out from the URDF, [A] assumed: look at these first. All keys: "
      "docs/reference/configuration.md\n\n"
      "name: {}\n{}",
      d.chain.model().name(), part.urdf.filename().generic_string(), quoted(d.chain.model().name()),
      part_lines(part, folder));
  if (d.n_p > 0)
    text += fmt::format("gantry: {}  # [V] the first prismatic joints\n", list_of(d, 0, d.n_p));
  text += fmt::format("manipulator: {}\n", list_of(d, d.n_p, d.chain.model().nv()));
  text += fmt::format("handle: {}  # [A] frame that is held, at the force/torque sensor\n",
                      quoted(d.chain.model().frame_names()[d.handle]));
  text += "rate_Hz: 1000\n";
  if (d.stands) {
    text += fmt::format("floor_z_m: -{}  # [A] it stands on a table\n", rounded(kTableHeight));
  }
  std::vector<DrivenJoint> joints;
  if (drives != Drives::kIdeal) joints = driven_joints(d);
  if (joints.empty()) drives = Drives::kIdeal;
  text += drive_lines(joints, drives, simulation_file);
  text += joint_lines(d) + posture_lines(d) + virtual_joint_lines(d) + box_lines(d, reach) +
          collision_lines(d.shapes);
  DeviceFiles files = {
      .device = text, .simulation = {}, .news = news_of(d.shapes), .doubts = doubts_of(d, reach)};
  if (drives != Drives::kIdeal) {
    files.simulation = simulation_yaml(d.chain.model().name(), joints, drives);
  }
  return files;
}

}  // namespace hg::new_files
