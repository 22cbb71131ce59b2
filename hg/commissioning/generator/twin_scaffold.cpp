#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <ranges>
#include <string>
#include <tuple>
#include <vector>

#include "hg/commissioning/generator/postures.h"
#include "hg/commissioning/generator/scaffold.h"
#include "hg/config/twin.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/start_posture.h"

namespace hg::generator {
namespace {

constexpr int kPostures = 24;    // in which a placement is tried
constexpr double kNear = 0.02;   // m, from here on a joint mostly turns the end effector
constexpr int kPlacements = 40;  // number of placements tried in all postures
constexpr double kRoom = 0.05;   // share of a range, kept from a joint's limits at the start
constexpr int kTrials = 8;       // number of those in which a hand leads the twin
constexpr std::uintmax_t kMostBytes = 4'000'000;  // of a URDF, as SourceReader
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

struct Placement {
  Pose T_B_root;
  double yaw = 0.0;
  double share = -1.0;  ///< share of the postures that the device can follow
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
  d.end_effector = held_frame(d.chain.model());
  d.ranges = joint_ranges(d.chain.model());
  const int n = d.chain.model().nv();
  d.start.resize(n);
  d.lever = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) {
    const Interval position = joint(d, i).position;
    d.start[i] = std::clamp(0.0, position.lb, position.ub);
  }
  PostureSampler sampler(d.ranges);
  for (int k = 0; k < 200; ++k) {
    d.chain.update_kinematics(sampler.draw(), Eigen::VectorXd::Zero(n));
    const model::Jacobian J = d.chain.jacobian(d.end_effector);
    for (int i = 0; i < n; ++i) d.lever[i] = std::max(d.lever[i], J.col(i).head<3>().norm());
  }
  return d;
}

Pose tip(Mechanism& d, const Eigen::VectorXd& q) {
  d.chain.update_kinematics(q, Eigen::VectorXd::Zero(q.size()));
  return d.chain.pose(d.end_effector);
}

// tests whether the device can hold its handle at a pose
class Reach {
 public:
  explicit Reach(const config::DeviceConfig& device)
      : device_(device),
        twin_{.name = "draft",
              .model = {.chain = model::ChainModel::free_body({}),
                        .end_effector = 0,
                        .q_start = ConfigurationA::Zero(7)}} {}

  bool contains(const Pose& T_B_H) { return start_at(T_B_H).has_value(); }

  // the same, with every joint of the device well inside its limits
  bool contains_with_room(const Pose& T_B_H) {
    const std::optional<scenario::Start> start = start_at(T_B_H);
    if (!start) return false;
    for (int i = 0; i < device_.model.n_m; ++i) {
      const limits::JointLimits& range = device_.model.joint_limits[i];
      const double room = kRoom * (range.q_max - range.q_min);
      const double q = start->q_m[i];
      if (std::isfinite(room) && std::min(q - range.q_min, range.q_max - q) < room) return false;
    }
    return true;
  }

 private:
  std::optional<scenario::Start> start_at(const Pose& T_B_H) {
    ConfigurationA& q = twin_.model.q_start;
    q.head<3>() = T_B_H.p;
    q.segment<4>(3) = Eigen::Quaterniond(T_B_H.R).normalized().coeffs();
    try {
      return scenario::find_start(device_, twin_);
    } catch (const SetupError&) {
      return {};
    }
  }

  const config::DeviceConfig& device_;
  config::Twin twin_;
};

// the handle with every joint of the device at its goal or in the middle of its range
Pose nominal_handle(const config::DeviceConfig& device) {
  model::ChainData chain(device.model.chain);
  const std::vector<Interval> ranges = joint_ranges(device.model.chain);
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

// Upright, turned and moved: all placements at which the device reaches the start, with the share
// of other postures that it reaches, best first. Ends at the first kEnough that reach all.
std::vector<Placement> find_placements(Mechanism& d, const config::DeviceConfig& device) {
  Reach reach(device);
  const Pose nominal = nominal_handle(device);
  const Pose T_root_start = tip(d, d.start);
  std::vector<Pose> others;
  PostureSampler sampler(d.ranges);
  for (int k = 0; k < kPostures; ++k) others.push_back(tip(d, sampler.draw()));

  std::vector<Placement> found;
  int whole = 0;
  for (const Eigen::Vector3d& offset : offsets()) {
    for (int turn = 0; turn < 12; ++turn) {
      if (std::ssize(found) >= kPlacements || whole >= kTrials) continue;
      const double yaw = turn * M_PI / 6.0;
      const Eigen::Matrix3d R(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
      const Pose T_B_root{nominal.p + offset - R * T_root_start.p, R};
      if (!reach.contains_with_room(T_B_root * T_root_start)) continue;
      const auto count = std::ranges::count_if(
          others, [&](const Pose& T_root_E) { return reach.contains(T_B_root * T_root_E); });
      found.push_back({T_B_root, yaw, static_cast<double>(count) / kPostures, true});
      if (count == kPostures) ++whole;
    }
  }
  std::ranges::stable_sort(found, std::greater(), &Placement::share);
  if (found.empty()) found.push_back({nominal * inverse(T_root_start), 0.0, 0.0, false});
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
         "}  # [V] tilted: upright the device cannot hold this end effector well at the start;\n"
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

std::string joint_lines(Mechanism& d, const TipRatings& ratings) {
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(d.chain.model().nv());
  d.chain.update(d.start, at_rest);
  const Eigen::MatrixXd M = d.chain.M();
  std::string text =
      "\njoints:  # positions and speeds that do not stand here are those of the URDF\n";
  for (int i = 0; i < d.chain.model().nv(); ++i) {
    const model::Joint& j = joint(d, i);
    const bool turns = !j.is_slide();
    const std::string unit = turns ? "rad" : "m";
    const double lever = std::max(d.lever[i], 1e-6);
    const double speed =
        turns ? std::min(ratings.turn_speed, ratings.speed / lever) : ratings.speed;
    const double braking =
        turns ? std::min(ratings.turn_braking, ratings.braking / lever) : ratings.braking;
    text += fmt::format("  {}:\n", quoted(j.name));
    const std::string where = !turns          ? "moves the end effector along"
                              : lever > kNear ? rounded(lever) + " m from the end effector"
                                              : "turns the end effector";
    text += fmt::format("    ddq_max_{}_per_s2: {}  # [V] {}\n", unit, rounded(braking), where);
    if (j.velocity_max > speed) {
      text += fmt::format("    dq_max_{}_per_s: {}  # [V] the hand of the device is no faster\n",
                          unit, rounded(speed));
    }
    if (j.damping > 0.0 || j.friction > 0.0) {
      text += fmt::format("    # damping {} and friction {} are those of the URDF\n",
                          rounded(j.damping), rounded(j.friction));
      continue;
    }
    text += fmt::format("    damping_{}: {}  # [A] let go it coasts for about {} s\n",
                        turns ? "Nms_per_rad" : "Ns_per_m", rounded(M(i, i) / kCoasting),
                        rounded(kCoasting));
  }
  return text;
}

std::string yaml_of(Mechanism& d, const Placement& placement, const ChainPart& part,
                    const std::filesystem::path& folder, const config::DeviceConfig& device) {
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
         joint_lines(d, tip_ratings(device));
}

// Leads a hand through the twin of a draft whose URDF stands beside it.
checks::Way lead(const std::string& yaml, const ChainPart& part, const std::string& urdf,
                 const config::SimulatedDeviceConfig& device) {
  config::SourceReader reader({{"twin.yaml", yaml}, {part.urdf.filename().generic_string(), urdf}});
  const config::Twin twin = config::load_twin("twin.yaml", reader);
  try {
    return checks::lead(device, twin);
  } catch (const SetupError& error) {
    return {.share = 0.0, .twin_joint = twin.model.dofs[0].name, .fault = error.what()};
  }
}

// Whether `a` went better than `b`: farther, then nearer to no limit.
bool is_better(const checks::Way& a, const checks::Way& b) {
  const auto whole = [](const checks::Way& way) { return std::min(way.share, checks::kWholeWay); };
  if (whole(a) != whole(b)) return whole(a) > whole(b);
  return std::tuple(!a.fault.empty(), a.excess, a.at_limit_s) <
         std::tuple(!b.fault.empty(), b.excess, b.at_limit_s);
}

}  // namespace

TwinDraft draft_twin(const ChainPart& part, const std::filesystem::path& folder,
                     const config::SimulatedDeviceConfig& device,
                     const std::function<void(std::size_t, std::size_t)>& progress) {
  Mechanism d = make_mechanism(part);
  std::vector<Placement> placements = find_placements(d, device);
  const std::string urdf = read_file(part.urdf, kMostBytes);
  TwinDraft best;
  const Placement* chosen = nullptr;
  const std::size_t most = std::min<std::size_t>(kTrials, placements.size());
  std::size_t trials = 0;
  for (const Placement& placement : placements | std::views::take(most)) {
    const checks::Way way =
        lead(yaml_of(d, placement, part, part.urdf.parent_path(), device), part, urdf, device);
    if (progress) progress(++trials, most);
    if (chosen != nullptr && !is_better(way, best.way)) continue;
    chosen = &placement;
    best.way = way;
    if (checks::trouble_of(way).empty()) break;
  }
  if (progress) progress(most, most);
  best.yaml = yaml_of(d, *chosen, part, folder, device);
  return best;
}

}  // namespace hg::generator
