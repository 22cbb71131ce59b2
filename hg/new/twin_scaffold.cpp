#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <ranges>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "hg/check/scenario_inspection.h"
#include "hg/config/twin.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/error.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/new/scaffold.h"
#include "hg/scenario/start_posture.h"
#include "hg/workspace/postures.h"
#include "hg/workspace/way.h"

namespace hg::new_files {
namespace {

constexpr int kPostures = 24;       // in which a placement is tried
constexpr double kNear = 0.02;      // m, from here on a joint mostly turns the end effector
constexpr int kPlacements = 40;     // number of placements tried in all postures
constexpr double kRoom = 0.05;      // share of a range, kept from a joint's limits at the start
constexpr int kTrials = 8;          // number of those in which a hand leads the twin
constexpr double kShare = 0.8;      // share of the speed and acceleration of the device's handle
constexpr double kTurnShare = 0.5;  // share of the rating of the slowest of the last three joints
constexpr double kCoasting = 1.5;   // s, time constant of a released joint

struct Mechanism {
  model::ChainData chain;
  int end_effector = 0;
  std::vector<Interval> ranges;
  Eigen::VectorXd start;
  Eigen::VectorXd lever;  ///< how far a joint moves the tip at most: m/rad, or 1
};

constexpr std::array kMassScales = {1.5, 2.0, 3.0, 5.0};  // tried against shaking

/// The largest speed and acceleration of a joint of the twin, as they are written down.
struct JointRating {
  double speed = 0.0, braking = 0.0;
};

struct Placement {
  Pose T_B_root;
  double yaw = 0.0;
  double share = -1.0;  ///< share of the postures that the device reaches
  bool has_room = false;
  bool is_upright = true;
};

const model::Joint& joint(const Mechanism& d, int i) { return d.chain.model().joints()[i]; }

Mechanism make_mechanism(const ChainPart& part) {
  Mechanism d{.chain = model::ChainData(read_part(part)), .ranges = {}, .start = {}, .lever = {}};
  for (const model::Joint& joint : d.chain.model().joints()) {
    if (joint.nv == 1) continue;
    throw SetupError(part.urdf.generic_string() + ": joint " + joint.name +
                     ": is floating; a draft is made for joints with one coordinate");
  }
  d.end_effector = held_frame(d.chain.model(), 1);
  d.ranges = workspace::joint_ranges(d.chain.model());
  const int n = d.chain.model().nv();
  d.start.resize(n);
  d.lever = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) {
    const Interval position = joint(d, i).position;
    d.start[i] = std::clamp(0.0, position.lb, position.ub);
  }
  workspace::PostureSampler sampler(d.ranges);
  for (int k = 0; k < 200; ++k) {
    d.chain.update_kinematics(sampler.draw(), Eigen::VectorXd::Zero(n));
    const model::Jacobian J = d.chain.jacobian(d.end_effector);
    for (int i = 0; i < n; ++i) d.lever[i] = std::max(d.lever[i], J.col(i).head<3>().norm());
  }
  return d;
}

// What its lengths make doubtful; empty: nothing.
std::string doubt_of(const Mechanism& d) {
  constexpr double kFarthest = 30.0, kOnAxis = 1e-3;  // m
  const std::string& held = d.chain.model().frame_names()[d.end_effector];
  for (int i = 0; i < d.lever.size(); ++i) {
    const bool is_slide = joint(d, i).is_slide();
    const double way = is_slide ? d.ranges[i].ub - d.ranges[i].lb : d.lever[i];
    if (way < kFarthest) continue;
    return fmt::format(
        "joint {} moves {} by up to {:.3g} m{}: are the lengths of the URDF millimetres? {:.3g} m",
        joint(d, i).name, held, way, is_slide ? "" : " per rad", 1e-3 * way);
  }
  if (d.lever.maxCoeff() > kOnAxis) return "";
  return fmt::format(
      "{} is on the axis of {}, a hand there can only turn it: give the URDF a link where it is "
      "held, on a fixed joint with an <origin>, and name it in end_effector",
      held, joint(d, 0).name);
}

Pose tip(Mechanism& d, const Eigen::VectorXd& q) {
  d.chain.update_kinematics(q, Eigen::VectorXd::Zero(q.size()));
  return d.chain.pose(d.end_effector);
}

constexpr double kShapeRoom = 0.005;  // m, beyond the safe distance between shapes of the device

// tests whether the device can hold its handle at a pose
class Reach {
 public:
  explicit Reach(const config::DeviceConfig& device)
      : device_(device),
        chain_(device.model.chain),
        shapes_(device.collision.shapes, device.collision.pairs.watched),
        twin_{.name = "draft",
              .model = {.chain = model::ChainModel::free_body({}),
                        .end_effector = 0,
                        .q_start = ConfigurationA::Zero(7)}} {}

  std::optional<scenario::Start> start_at(const Pose& T_B_H) {
    ConfigurationA& q = twin_.model.q_start;
    q.head<3>() = T_B_H.p;
    q.segment<4>(3) = Eigen::Quaterniond(T_B_H.R).normalized().coeffs();
    try {
      const scenario::Start start = scenario::find_start(device_, twin_);
      if (is_clear(start)) return start;
    } catch (const SetupError&) {
    }
    return {};
  }

 private:
  // whether all watched shapes of the device have some room to move
  bool is_clear(const scenario::Start& start) {
    chain_.update_poses(stacked(start.q_p, start.q_m));
    return shapes_.distance(chain_) > device_.collision.safe_distance + kShapeRoom;
  }

  const config::DeviceConfig& device_;
  model::ChainData chain_;
  const collision::Nearest shapes_;
  config::Twin twin_;
};

// Whether gantry, joints and sums of joints are well inside their ranges.
bool has_room(const DeviceModel& device, const scenario::Start& start) {
  const auto is_inside = [](double q, const Interval& range) {
    const double room = kRoom * (range.ub - range.lb);
    return !std::isfinite(room) || std::min(q - range.lb, range.ub - q) >= room;
  };
  for (int i = 0; i < device.n_p; ++i) {
    if (!is_inside(start.q_p[i], device.gantry_range[i])) return false;
  }
  for (int i = 0; i < device.n_m; ++i) {
    const limits::JointLimits& limits = device.joint_limits[i];
    if (!is_inside(start.q_m[i], {limits.q_min, limits.q_max})) return false;
  }
  return std::ranges::all_of(device.virtual_joints, [&](const VirtualJoint& sum) {
    return is_inside(sum.weights.dot(start.q_m), {sum.limits.q_min, sum.limits.q_max});
  });
}

// the handle with every joint of the device at its goal or in the middle of its range
Pose nominal_handle(const config::DeviceConfig& device) {
  model::ChainData chain(device.model.chain);
  const std::vector<Interval> ranges = workspace::joint_ranges(device.model.chain);
  Eigen::VectorXd q(chain.model().nq());
  for (int i = 0; i < q.size(); ++i) {
    const Interval range = ranges[i];
    q[i] = 0.5 * (range.lb + range.ub);
    const int goal = i - device.model.n_p;
    if (goal >= 0 && goal < device.model.posture.size() &&
        std::isfinite(device.model.posture[goal])) {
      q[i] = device.model.posture[goal];
    }
  }
  chain.update_kinematics(q, Eigen::VectorXd::Zero(chain.model().nv()));
  return chain.pose(device.model.handle);
}

// offsets from the nominal handle, near ones first
std::vector<Eigen::Vector3d> offsets() {
  std::vector<Eigen::Vector3d> grid;
  for (const int z : {-1, 0, 1}) {
    for (const int y : {-1, 0, 1}) {
      for (const int x : {-1, 0, 1}) grid.emplace_back(0.3 * x, 0.3 * y, 0.15 * z);
    }
  }
  std::ranges::stable_sort(grid, {}, [](const Eigen::Vector3d& p) { return p.norm(); });
  return grid;
}

// Where the end effector of an upright twin starts: its position, and the yaw of the twin.
struct Candidate {
  Eigen::Vector3d p;
  double yaw = 0.0;
};

std::vector<Candidate> around(const Eigen::Vector3d& nominal) {
  std::vector<Candidate> candidates;
  for (const Eigen::Vector3d& offset : offsets()) {
    for (int turn = 0; turn < 12; ++turn)
      candidates.push_back({nominal + offset, turn * M_PI / 6.0});
  }
  return candidates;
}

// Where the device holds its handle nearly as an upright twin needs it, in dexterous postures: a
// small arm has few such places, which a coarse grid misses.
std::vector<Candidate> where_it_is_held_so(const config::DeviceConfig& device,
                                           const Eigen::Matrix3d& R_root_start) {
  constexpr int kDrawn = 20000;
  constexpr std::size_t kMost = 120;
  constexpr double kTilt = 0.3;  // rad
  model::ChainData chain(device.model.chain);
  std::vector<Interval> ranges = workspace::joint_ranges(device.model.chain);
  for (int i = 0; i < device.model.n_m; ++i) {
    const limits::JointLimits& limits = device.model.joint_limits[i];
    Interval& range = ranges[device.model.n_p + i];
    range = intersect(range, {limits.q_min, limits.q_max});
  }
  workspace::PostureSampler sampler(ranges);
  std::vector<std::pair<double, Candidate>> found;
  for (int k = 0; k < kDrawn; ++k) {
    const Eigen::VectorXd q = sampler.draw();
    chain.update_poses(q);
    const Pose handle = chain.pose(device.model.handle);
    const double upright = handle.R.row(2).dot(R_root_start.row(2));
    if (upright < std::cos(kTilt)) continue;
    const Eigen::Matrix3d turned = handle.R * R_root_start.transpose();
    const double yaw = std::atan2(turned(1, 0) - turned(0, 1), turned(0, 0) + turned(1, 1));
    found.emplace_back(workspace::dexterity(chain, device.model.handle, device.model.n_p, q),
                       Candidate{handle.p, yaw});
  }
  std::ranges::stable_sort(found, std::greater(), [](const auto& entry) { return entry.first; });
  std::vector<Candidate> candidates;
  for (const auto& entry : found | std::views::take(kMost)) candidates.push_back(entry.second);
  return candidates;
}

// Placements of an upright twin at which the device reaches its start.
class PlacementSearch {
 public:
  PlacementSearch(Mechanism& d, const config::DeviceConfig& device)
      : device_(device), reach_(device), T_root_start_(tip(d, d.start)) {
    workspace::PostureSampler sampler(d.ranges);
    for (int k = 0; k < kPostures; ++k) others_.push_back(tip(d, sampler.draw()));
  }

  // Ends early with as many good ones as are tried.
  void look_at(const std::vector<Candidate>& candidates) {
    const std::size_t most = found_.size() + kPlacements;
    for (const Candidate& candidate : candidates) {
      if (found_.size() >= most || is_enough()) return;
      const Eigen::Matrix3d R(Eigen::AngleAxisd(candidate.yaw, Eigen::Vector3d::UnitZ()));
      const Pose T_B_root{candidate.p - R * T_root_start_.p, R};
      const std::optional<scenario::Start> start = reach_.start_at(T_B_root * T_root_start_);
      const bool is_roomy = start && has_room(device_.model, *start);
      if (!start || (!is_roomy && !found_.empty())) continue;  // one without room is enough
      const auto count = std::ranges::count_if(others_, [&](const Pose& T_root_E) {
        return reach_.start_at(T_B_root * T_root_E).has_value();
      });
      found_.push_back({.T_B_root = T_B_root,
                        .yaw = candidate.yaw,
                        .share = static_cast<double>(count) / kPostures,
                        .has_room = is_roomy});
      if (is_roomy && count == kPostures) ++good_;
    }
  }

  bool is_enough() const { return good_ >= kTrials; }

  // Best first: those with room at the start come before the others, then the share of other
  // postures that the device reaches counts.
  std::vector<Placement> take() {
    std::ranges::stable_sort(found_, std::greater(), [](const Placement& placement) {
      return std::tuple(placement.has_room, placement.share);
    });
    return std::move(found_);
  }

  const Pose& T_root_start() const { return T_root_start_; }

 private:
  const config::DeviceConfig& device_;
  Reach reach_;
  Pose T_root_start_;
  std::vector<Pose> others_;
  std::vector<Placement> found_;
  int good_ = 0;
};

// Upright, turned and moved, best first; without any, one that is tilted.
std::vector<Placement> find_placements(Mechanism& d, const config::DeviceConfig& device) {
  const Pose nominal = nominal_handle(device);
  PlacementSearch search(d, device);
  search.look_at(around(nominal.p));
  if (!search.is_enough()) search.look_at(where_it_is_held_so(device, search.T_root_start().R));
  std::vector<Placement> found = search.take();
  if (found.empty()) {
    found.push_back(
        {.T_B_root = nominal * inverse(search.T_root_start()), .share = 0.0, .is_upright = false});
  }
  return found;
}

std::string placement_line(const Placement& placement) {
  const Eigen::Vector3d& p = placement.T_B_root.p;
  std::string text =
      fmt::format("placement: {{x_m: {:.3f}, y_m: {:.3f}, z_m: {:.3f}", p.x(), p.y(), p.z());
  if (placement.is_upright) {
    if (placement.yaw != 0.0) text += fmt::format(", yaw_rad: {:.6f}", placement.yaw);
    return text + fmt::format("}}  # [V] the device reaches {:.0f} % of the twin's postures\n",
                              100.0 * placement.share);
  }
  const Eigen::Matrix3d& R = placement.T_B_root.R;
  const double pitch = -std::asin(std::clamp(R(2, 0), -1.0, 1.0));
  text += fmt::format(", roll_rad: {:.6f}, pitch_rad: {:.6f}, yaw_rad: {:.6f}",
                      std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0)));
  return text +
         "}  # [V] tilted: upright the device cannot hold this end effector at the start;\n"
         "# give the URDF a frame turned like the handle of the device to place it upright\n";
}

// how fast the end effector of the twin may be for the handle of the device to follow
struct TipRatings {
  double speed = 1.2;          // m/s
  double braking = 4.0;        // m/s^2
  double turn_speed = 2.5;     // rad/s
  double turn_braking = 20.0;  // rad/s^2
};

TipRatings tip_ratings(const config::DeviceConfig& device) {
  limits::JointLimits hand{.dq_max = 1.5, .ddq_max = 5.0};
  for (const limits::JointLimits& axis : handle_limits(device.model)) {
    hand.dq_max = std::min(hand.dq_max, axis.dq_max);
    hand.ddq_max = std::min(hand.ddq_max, axis.ddq_max);
  }
  TipRatings ratings{.speed = kShare * hand.dq_max, .braking = kShare * hand.ddq_max};
  for (std::size_t i = device.model.joint_limits.size() - 3; i < device.model.joint_limits.size();
       ++i) {
    const limits::JointLimits& wrist = device.model.joint_limits[i];
    ratings.turn_speed = std::min(ratings.turn_speed, kTurnShare * wrist.dq_max);
    ratings.turn_braking = std::min(ratings.turn_braking, kTurnShare * wrist.ddq_max);
  }
  return ratings;
}

// Two digits, downwards: values that may not be exceeded.
double rounded_down(double value) {
  const double near = std::stod(rounded(value));
  return near <= value ? near : std::stod(rounded(0.95 * value));
}

std::vector<JointRating> joint_ratings(const Mechanism& d, const config::DeviceConfig& device) {
  const TipRatings tip = tip_ratings(device);
  std::vector<JointRating> ratings;
  for (int i = 0; i < d.chain.model().nv(); ++i) {
    const bool turns = !joint(d, i).is_slide();
    const double lever = std::max(d.lever[i], 1e-6);
    JointRating rating = {.speed = tip.speed, .braking = tip.braking};
    if (turns) {
      rating.speed = std::min(tip.turn_speed, tip.speed / lever);
      rating.braking = std::min(tip.turn_braking, tip.braking / lever);
    }
    rating.speed = std::min(rating.speed, joint(d, i).velocity_max);
    ratings.push_back(rating);
  }
  return ratings;
}

// What a device can follow and brake where the twin stands, in all its postures: as `check` says.
void lower(const Mechanism& d, const check::Match& match, std::vector<JointRating>& ratings) {
  for (std::size_t i = 0; i < ratings.size(); ++i) {
    JointRating& rating = ratings[i];
    const check::Demand& demand = match.demands[i];
    const double braking = std::max(demand.acceleration, demand.joint_acceleration);
    if (braking > 1.0) rating.braking = rounded_down(rating.braking / braking);
    if (demand.speed > 1.0) rating.speed = rounded_down(rating.speed / demand.speed);
    const double range = d.ranges[i].ub - d.ranges[i].lb;
    const double fastest = std::sqrt(rating.braking * range);  // braked within half the range
    if (rating.speed > fastest) rating.speed = rounded_down(fastest);
  }
}

std::string joint_lines(Mechanism& d, const std::vector<JointRating>& ratings, double mass_scale) {
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(d.chain.model().nv());
  d.chain.update(d.start, at_rest);
  const Eigen::MatrixXd M = d.chain.M();
  std::string text =
      "\njoints:  # positions and speeds that do not stand here are those of the URDF\n";
  for (int i = 0; i < d.chain.model().nv(); ++i) {
    const model::Joint& j = joint(d, i);
    const bool turns = !j.is_slide();
    const std::string unit = turns ? "rad" : "m";
    const std::string where = !turns ? "moves the end effector along"
                              : d.lever[i] > kNear
                                  ? rounded(d.lever[i]) + " m from the end effector"
                                  : "turns the end effector";
    text += fmt::format("  {}:\n    ddq_max_{}_per_s2: {}  # [V] {}\n", quoted(j.name), unit,
                        rounded(ratings[i].braking), where);
    if (j.velocity_max > ratings[i].speed) {
      text += fmt::format("    dq_max_{}_per_s: {}  # [V] the hand of the device is no faster\n",
                          unit, rounded(ratings[i].speed));
    }
    if (j.damping > 0.0 || j.friction > 0.0) {
      text += fmt::format("    # damping {} and friction {} are those of the URDF\n",
                          rounded(j.damping), rounded(j.friction));
      continue;
    }
    text += fmt::format("    damping_{}: {}  # [A] let go it coasts for about {} s\n",
                        turns ? "Nms_per_rad" : "Ns_per_m",
                        rounded(mass_scale * M(i, i) / kCoasting), rounded(kCoasting));
  }
  return text;
}

std::string yaml_of(Mechanism& d, const Placement& placement,
                    const std::vector<JointRating>& ratings, double mass_scale,
                    const ChainPart& part, const std::filesystem::path& folder,
                    const config::DeviceConfig& device) {
  return fmt::format(
             "# {} as a twin, from {}, placed for the device {}.\n"
             "# [V] worked out from the URDF, [A] assumed: look at these first. All keys: "
             "docs/reference/configuration.md\n\n"
             "name: {}\n{}"
             "end_effector: {}  # [A] frame that the hand holds\n",
             d.chain.model().name(), part.urdf.filename().generic_string(), device.name,
             quoted(d.chain.model().name()), part_lines(part, folder),
             quoted(d.chain.model().frame_names()[d.end_effector])) +
         placement_line(placement) +
         "gravity: false  # true: the hand carries the weight of the twin\n" +
         (mass_scale == 1.0
              ? ""
              : fmt::format("mass_scale: {:g}  # [V] lighter it shakes in a hand on this device\n",
                            mass_scale)) +
         joint_lines(d, ratings, mass_scale);
}

// A trial of a draft. The worst is one that cannot begin.
struct Trial {
  workspace::Way way;
  std::string refusal;  ///< why it cannot; empty: it began

  std::string problem() const { return refusal.empty() ? workspace::problem_of(way) : refusal; }
};

// Drafts of one mechanism for one device, in different places.
class Drafts {
 public:
  Drafts(Mechanism& mechanism, const ChainPart& part, const config::SimulatedDeviceConfig& device)
      : d_(mechanism),
        part_(part),
        device_(device),
        beside_(part.urdf.parent_path()),
        urdf_(config::SourceReader().read(part.urdf)),
        urdf_name_(urdf_in(part, beside_)) {}

  // Ratings for a place that `check` accepts; as they are where it cannot be looked at.
  std::vector<JointRating> ratings_at(const Placement& placement) {
    std::vector<JointRating> ratings = joint_ratings(d_, device_);
    for (JointRating& rating : ratings) rating.braking = std::stod(rounded(rating.braking));
    try {
      lower(d_, check::match(device_, load(placement, ratings, 1.0)), ratings);
    } catch (const SetupError&) {
    }
    return ratings;
  }

  // Leads a hand through the twin.
  Trial try_out(const Placement& placement, const std::vector<JointRating>& ratings,
                double mass_scale) {
    try {
      return {.way = workspace::lead(device_, load(placement, ratings, mass_scale)), .refusal = {}};
    } catch (const SetupError& error) {
      return {.way = {.share = -1.0}, .refusal = error.what()};
    }
  }

 private:
  config::Twin load(const Placement& placement, const std::vector<JointRating>& ratings,
                    double mass_scale) {
    const std::string yaml = yaml_of(d_, placement, ratings, mass_scale, part_, beside_, device_);
    config::SourceReader reader({{"twin.yaml", yaml}, {urdf_name_, urdf_}});
    return config::load_twin("twin.yaml", reader);
  }

  Mechanism& d_;
  const ChainPart& part_;
  const config::SimulatedDeviceConfig& device_;
  std::filesystem::path beside_;
  std::string urdf_, urdf_name_;
};

// Whether `a` went better than `b`: farther, then without a fault, then with fewer limits in the
// way.
bool is_better(const workspace::Way& a, const workspace::Way& b) {
  const auto whole = [](const workspace::Way& way) {
    return std::min(way.share, workspace::kWholeWay);
  };
  if (whole(a) != whole(b)) return whole(a) > whole(b);
  return std::tuple(!a.fault.empty(), a.excess, a.at_limit_s, a.rushed_s) <
         std::tuple(!b.fault.empty(), b.excess, b.at_limit_s, b.rushed_s);
}

// Whether nothing but an oscillation of hand and device was in the way.
bool is_only_shaken(const Trial& trial) {
  workspace::Way calm = trial.way;
  calm.shaken_s = 0.0;
  return trial.refusal.empty() && trial.way.shaken_s > 0.0 && workspace::problem_of(calm).empty();
}

}  // namespace

TwinDraft draft_twin(const ChainPart& part, const std::filesystem::path& folder,
                     const config::SimulatedDeviceConfig& device,
                     const std::function<void(std::size_t, std::size_t)>& progress) {
  Mechanism d = make_mechanism(part);
  std::vector<Placement> placements = find_placements(d, device);
  Drafts drafts(d, part, device);
  Trial best;
  const Placement* chosen = nullptr;
  std::vector<JointRating> ratings;
  const std::size_t most = std::min<std::size_t>(kTrials, placements.size());
  std::size_t trials = 0;
  for (const Placement& placement : placements | std::views::take(most)) {
    const std::vector<JointRating> tried = drafts.ratings_at(placement);
    const Trial trial = drafts.try_out(placement, tried, 1.0);
    if (progress) progress(++trials, most);
    if (chosen != nullptr && !is_better(trial.way, best.way)) continue;
    chosen = &placement;
    best = trial;
    ratings = tried;
    if (best.problem().empty()) break;
  }
  double mass_scale = 1.0;
  for (const double scale : kMassScales) {
    if (!is_only_shaken(best)) break;
    const Trial trial = drafts.try_out(*chosen, ratings, scale);
    if (!trial.problem().empty()) continue;
    best = trial;
    mass_scale = scale;
  }
  if (progress) progress(most, most);
  return {.yaml = yaml_of(d, *chosen, ratings, mass_scale, part, folder, device),
          .problem = best.problem(),
          .note = mass_scale == 1.0
                      ? ""
                      : fmt::format("{:g} times as heavy as in its URDF (mass_scale): lighter it "
                                    "shakes in a hand on this device",
                                    mass_scale),
          .doubt = doubt_of(d)};
}

}  // namespace hg::new_files
