#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hg/commissioning/generator/postures.h"
#include "hg/commissioning/generator/scaffold.h"
#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/start_posture.h"

namespace hg::generator {
namespace {

constexpr int kPostures = 24;       // in which a placement is tried
constexpr double kNear = 0.02;      // m, from here on a joint mostly turns the end effector
constexpr int kPlacements = 40;     // number of placements tried in all postures
constexpr double kShare = 0.8;      // share of the speed and acceleration of the device's handle
constexpr double kTurnShare = 0.5;  // share of the rating of the slowest of the last three joints
constexpr double kCoasting = 1.5;   // s, time constant of a released joint

struct TwinDraft {
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

const model::Joint& joint(const TwinDraft& d, int i) { return d.chain.model().joints()[i]; }

TwinDraft make_draft(const ChainPart& part) {
  TwinDraft d{.chain = model::ChainData(read_part(part)), .ranges = {}, .start = {}, .lever = {}};
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

Pose tip(TwinDraft& d, const Eigen::VectorXd& q) {
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

  bool contains(const Pose& T_B_H) {
    ConfigurationA& q = twin_.model.q_start;
    q.head<3>() = T_B_H.p;
    q.segment<4>(3) = Eigen::Quaterniond(T_B_H.R).normalized().coeffs();
    try {
      scenario::find_start(device_, twin_);
      return true;
    } catch (const SetupError&) {
      return false;
    }
  }

 private:
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

// upright, turned and moved until the device reaches the start and most other postures
Placement find_placement(TwinDraft& d, const config::DeviceConfig& device) {
  Reach reach(device);
  const Pose nominal = nominal_handle(device);
  const Pose T_root_start = tip(d, d.start);
  std::vector<Pose> others;
  PostureSampler sampler(d.ranges);
  for (int k = 0; k < kPostures; ++k) others.push_back(tip(d, sampler.draw()));

  Placement best;
  int tried = 0;
  for (const Eigen::Vector3d& offset : offsets()) {
    for (int turn = 0; turn < 12 && tried < kPlacements && best.share < 1.0; ++turn) {
      const double yaw = turn * M_PI / 6.0;
      const Eigen::Matrix3d R(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
      const Pose T_B_root{nominal.p + offset - R * T_root_start.p, R};
      if (!reach.contains(T_B_root * T_root_start)) continue;
      const auto count = std::ranges::count_if(
          others, [&](const Pose& T_root_E) { return reach.contains(T_B_root * T_root_E); });
      const double share = static_cast<double>(count) / kPostures;
      if (share > best.share) best = {T_B_root, yaw, share, true};
      ++tried;
    }
  }
  if (best.share >= 0.0) return best;
  const Pose tilted = nominal * inverse(T_root_start);
  return {tilted, 0.0, 0.0, false};
}

std::string placement_line(const Placement& placement) {
  const Eigen::Vector3d& p = placement.T_B_root.p;
  std::string text =
      fmt::format("placement: {{x_m: {:.3f}, y_m: {:.3f}, z_m: {:.3f}", p.x(), p.y(), p.z());
  if (placement.is_upright) {
    if (placement.yaw != 0.0) text += fmt::format(", yaw_rad: {:.6f}", placement.yaw);
    return text + fmt::format("}}  # [V] the device follows {:.0f} % of the postures of the twin\n",
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

std::string joint_lines(TwinDraft& d, const TipRatings& ratings) {
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
    text += fmt::format("    damping_{}: {}  # [A] let go it coasts for about {} s\n",
                        turns ? "Nms_per_rad" : "Ns_per_m", rounded(M(i, i) / kCoasting),
                        rounded(kCoasting));
  }
  return text;
}

}  // namespace

std::string twin_yaml(const ChainPart& part, const std::filesystem::path& folder,
                      const config::DeviceConfig& device) {
  TwinDraft d = make_draft(part);
  const Placement placement = find_placement(d, device);
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

}  // namespace hg::generator
