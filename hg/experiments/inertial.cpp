#include "hg/experiments/inertial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "hg/controller/cycle_state.h"
#include "hg/core/stacked.h"
#include "hg/experiments/player.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/assembly.h"

namespace hg::experiments {
namespace {

constexpr std::size_t kLags = 12;  // periods that the units may be late

// The first link that each joint moves, root to tip.
std::vector<std::string> moved_links(const config::DeviceConfig& device) {
  model::ChainData chain(device.model.chain);
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(chain.model().nv(), 0.5);
  chain.update_kinematics(q, Eigen::VectorXd::Zero(chain.model().nv()));
  std::vector<std::string> links;
  Eigen::Index moved = 0;
  for (const std::string& name : chain.model().frame_names()) {
    const model::Jacobian& J = chain.jacobian(chain.model().frame(name));
    Eigen::Index joints = 0;
    while (joints < J.cols() && J.col(joints).norm() > 0.0) ++joints;
    if (joints <= moved) continue;
    moved = joints;
    links.push_back(name);
  }
  return links;
}

// Mean squares under way.
struct Squares {
  double joint_speed = 0.0, joint_acceleration = 0.0, gantry = 0.0;
  double handle_speed = 0.0, handle_acceleration = 0.0;

  EstimateErrors errors(double samples, int n_m, int n_p) const {
    const auto rms = [&](double sum, int parts) {
      return parts > 0 && samples > 0.0 ? std::sqrt(sum / (samples * parts)) : 0.0;
    };
    return {.joint_speed = rms(joint_speed, n_m),
            .joint_acceleration = rms(joint_acceleration, n_m),
            .gantry_acceleration = rms(gantry, n_p),
            .handle_speed = rms(handle_speed, 1),
            .handle_acceleration = rms(handle_acceleration, 1)};
  }
};

// Believed motion of all joints, and known motion of the bending root.
struct Belief {
  VectorPM dq, ddq;
  Vector6 bend_rate = Vector6::Zero(), bend_acceleration = Vector6::Zero();
};

// Twist of the handle that a twist of the root makes.
Vector6 at_handle(const Vector6& root, const Eigen::Vector3d& from_root) {
  Vector6 twist = root;
  twist.head<3>() += root.tail<3>().cross(from_root);
  return twist;
}

class Judge {
 public:
  Judge(const config::DeviceConfig& device, const UnitSet& units)
      : model_(device.model),
        chain_(model_.chain),
        dt_(device.model.dt()),
        root_(frames_of(device, units.links).front()) {}

  // The truth of the sample before is known when the next one is there.
  void add(const Sample& sample, bool counts) {
    const RobotState& robot = sample.record.robot;
    const InertialReport& inertial = sample.record.inertial;
    Moment now = {.truth = sample.truth};
    const VectorM& ddq_m = sample.record.reference.ddq_m;
    now.reference = {.dq = stacked(robot.dq_p, robot.dq_m), .ddq = stacked(robot.ddq_p, ddq_m)};
    now.encoders = now.reference;
    if (has_last_) {
      now.encoders.ddq.tail(model_.n_m) = (robot.dq_m - last_.encoders.dq.tail(model_.n_m)) / dt_;
    }
    now.inertial = {.dq = inertial.dq,
                    .ddq = inertial.ddq,
                    .bend_rate = inertial.bend_rate,
                    .bend_acceleration = inertial.bend_acceleration};
    if (has_before_ && counts) judge(now);
    before_ = last_;
    last_ = now;
    has_before_ = has_last_;
    has_last_ = true;
  }

  InertialRun result() const {
    InertialRun run;
    run.judged_s = samples_ * dt_;
    run.reference = reference_.errors(samples_, model_.n_m, model_.n_p);
    run.encoders = encoders_.errors(samples_, model_.n_m, model_.n_p);
    run.inertial = inertial_.errors(samples_, model_.n_m, model_.n_p);
    run.lateness = dt_ * best_lag();
    run.bump = bump_;
    return run;
  }

 private:
  struct Moment {
    Truth truth;
    Belief reference, encoders, inertial;
  };

  void judge(const Moment& next) {
    const Truth& truth = last_.truth;
    const VectorPM dq = stacked(truth.dq_p, truth.dq_m);
    const VectorM ddq_m = (next.truth.dq_m - before_.truth.dq_m) / (2.0 * dt_);
    const VectorPM ddq = stacked(truth.ddq_p, ddq_m);
    chain_.update_kinematics(stacked(truth.q_p, truth.q_m), dq);
    compare(last_.reference, dq, ddq, reference_);
    compare(last_.encoders, dq, ddq, encoders_);
    compare(last_.inertial, dq, ddq, inertial_);
    const int n_m = model_.n_m;
    const VectorPM change = last_.inertial.ddq - before_.inertial.ddq;
    bump_ = std::max(bump_, change.tail(n_m).cwiseAbs().maxCoeff());
    correlate((ddq - last_.reference.ddq).tail(n_m),
              (last_.inertial.ddq - last_.reference.ddq).tail(n_m));
    samples_ += 1.0;
  }

  void compare(const Belief& belief, const VectorPM& dq, const VectorPM& ddq, Squares& squares) {
    const int n_m = model_.n_m, n_p = model_.n_p;
    const Eigen::Vector3d from_root = chain_.pose(model_.handle).p - chain_.pose(root_).p;
    const model::Jacobian& J = chain_.jacobian(model_.handle);
    const Vector6 twist = J * belief.dq + at_handle(belief.bend_rate, from_root);
    const Vector6 acceleration = J * belief.ddq + chain_.bias_acceleration(model_.handle) +
                                 at_handle(belief.bend_acceleration, from_root);
    squares.joint_speed += (belief.dq - dq).tail(n_m).squaredNorm();
    squares.joint_acceleration += (belief.ddq - ddq).tail(n_m).squaredNorm();
    squares.gantry += (belief.ddq - ddq).head(n_p).squaredNorm();
    squares.handle_speed += (twist - last_.truth.twist).head<3>().squaredNorm();
    squares.handle_acceleration +=
        (acceleration - last_.truth.acceleration).head<3>().squaredNorm();
  }

  void correlate(const VectorM& truth, const VectorM& said) {
    for (std::size_t lag = kLags - 1; lag > 0; --lag) past_[lag] = past_[lag - 1];
    past_[0] = truth;
    for (std::size_t lag = 0; lag < kLags; ++lag) {
      if (past_[lag].size() == said.size()) likeness_[lag] += past_[lag].dot(said);
    }
  }

  // Top of the parabola through the three best lags, periods.
  double best_lag() const {
    const std::size_t best = std::ranges::max_element(likeness_) - likeness_.begin();
    if (best == 0 || best + 1 == kLags) return static_cast<double>(best);
    const double left = likeness_[best - 1], right = likeness_[best + 1];
    const double curvature = left - 2.0 * likeness_[best] + right;
    return static_cast<double>(best) + 0.5 * (left - right) / curvature;
  }

  DeviceModel model_;
  model::ChainData chain_;
  double dt_;
  int root_;
  Moment before_, last_;
  bool has_before_ = false, has_last_ = false;
  Squares reference_, encoders_, inertial_;
  double samples_ = 0.0, bump_ = 0.0;
  std::array<VectorM, kLags> past_;
  std::array<double, kLags> likeness_{};
};

nlohmann::ordered_json to_json(const EstimateErrors& errors) {
  return {{"joint_speed", errors.joint_speed},
          {"joint_acceleration", errors.joint_acceleration},
          {"gantry_acceleration", errors.gantry_acceleration},
          {"handle_speed", errors.handle_speed},
          {"handle_acceleration", errors.handle_acceleration}};
}

}  // namespace

std::vector<int> frames_of(const config::DeviceConfig& device,
                           const std::vector<std::string>& links) {
  std::vector<int> frames;
  for (const std::string& link : links) frames.push_back(device.model.chain.frame(link));
  return frames;
}

std::vector<UnitSet> unit_sets(const config::DeviceConfig& device) {
  const std::vector<std::string> links = moved_links(device);
  const auto n_p = device.model.n_p;
  std::vector<std::string> all = links, arm(links.begin() + n_p, links.end());
  if (n_p > 0) all.erase(all.begin(), all.begin() + n_p - 1);  // the last axis carries them all
  if (all.size() > kMaxInertialUnits) all.resize(kMaxInertialUnits);
  std::vector<std::string> some;
  for (std::size_t i = 0; i < arm.size(); i += 2) some.push_back(arm[i]);
  std::vector<UnitSet> sets = {{"all", all},
                               {"all, one dies", all, true},
                               {"arm", arm},
                               {"every second of the arm", some},
                               {"last link", {arm.back()}}};
  if (n_p > 0) sets.push_back({"gantry", {all.front()}});
  return sets;
}

void learn_mounting(config::Scenario& scenario) {
  Player player(scenario);
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    player.run();
  }
  scenario.device.estimation.units.known =
      std::make_shared<estimation::UnitCalibrations>(player.cycle().state().estimation.units.units);
}

InertialRun play_with_units(const config::Scenario& original, const std::string& name,
                            const UnitSet& units, std::uint64_t seed) {
  config::Scenario scenario = original;
  set_seed(scenario, seed);
  scenario.device.estimation.units.frames = frames_of(scenario.device, units.links);
  scenario.device.estimation.units.feeds_back = false;
  const double middle_s = 0.5 * scenario::planned_duration_s(scenario);
  learn_mounting(scenario);
  Player player(scenario);
  Judge judge(scenario.device, units);
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    const double time_s = player.sensors().time_s;
    if (units.loses_one && time_s > middle_s) {
      const auto lost = static_cast<Eigen::Index>(units.links.size() / 2);
      player.sensors().inertial.segment<6>(6 * lost).setConstant(
          std::numeric_limits<double>::quiet_NaN());
    }
    player.run();
    judge.add(player.sample(), player.is_running() && time_s > 0.95 * middle_s);
  }
  InertialRun run = judge.result();
  run.scenario = name;
  run.units = units.name;
  run.seed = seed;
  const auto& trust = player.record().inertial.trust;
  run.trust = trust.size() > 0 ? trust.minCoeff() : 0.0;
  run.fault = player.record().fault.code;
  return run;
}

std::vector<InertialRun> measure_inertial(const std::vector<config::Scenario>& scenarios,
                                          const std::vector<std::string>& names, int seeds,
                                          const Progress& progress) {
  struct Case {
    std::size_t scenario;
    UnitSet units;
    std::uint64_t seed;
  };
  std::vector<Case> cases;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    for (const UnitSet& units : unit_sets(scenarios[i].device)) {
      for (int seed = 1; seed <= seeds; ++seed) {
        cases.push_back({i, units, static_cast<std::uint64_t>(seed)});
      }
    }
  }
  std::vector<InertialRun> runs(cases.size());
  do_all(
      cases.size(),
      [&](std::size_t i) {
        const Case& one = cases[i];
        runs[i] =
            play_with_units(scenarios[one.scenario], names[one.scenario], one.units, one.seed);
      },
      progress);
  return runs;
}

nlohmann::ordered_json to_json(const std::vector<InertialRun>& runs) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const InertialRun& run : runs) {
    all.push_back({{"scenario", run.scenario},
                   {"units", run.units},
                   {"seed", run.seed},
                   {"judged_s", run.judged_s},
                   {"reference", to_json(run.reference)},
                   {"encoders", to_json(run.encoders)},
                   {"inertial", to_json(run.inertial)},
                   {"lateness_s", run.lateness},
                   {"least_trust", run.trust},
                   {"largest_change", run.bump},
                   {"fault", static_cast<int>(run.fault)},
                   {"fault_text", to_string(run.fault)}});
  }
  return {{"runs", all}};
}

}  // namespace hg::experiments
