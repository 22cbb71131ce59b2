#include "hg/experiments/remote_operation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hg/core/error.h"
#include "hg/core/random.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/player.h"
#include "hg/model/chain_data.h"
#include "hg/teleoperation/teleoperation.h"

namespace hg::experiments {
namespace {

constexpr double kFelt = 2e-3;  // m

// A hand that pulls the handle about, often beyond what the arm reaches.
void draw_hand(const RemoteOperation& operation, std::uint64_t seed, config::Scenario& scenario) {
  constexpr double kMovesAlong = 0.7, kTurns = 0.4;                             // probabilities
  constexpr std::array<double, 6> kFarthest = {0.4, 0.45, 0.2, 1.2, 0.7, 1.2};  // m, rad
  Random random(seed);
  person::HandImpedance& hand = scenario.script.hand;
  hand.stiffness = Eigen::Vector3d::Constant(200.0 * std::pow(4.0, random.next()));
  hand.damping = Eigen::Vector3d::Constant(random.between(20.0, 60.0));
  hand.angular_stiffness = Eigen::Vector3d::Constant(random.between(2.0, 8.0));
  hand.angular_damping = Eigen::Vector3d::Constant(0.1);
  hand.force_max = operation.force * random.between(0.5, 1.0);
  hand.torque_max = 0.08 * hand.force_max;
  person::Script script;
  script.start[person::kGripChannel] = 1.0;
  std::array<double, 6> before{};
  double time = 1.0;
  while (time < operation.duration_s) {
    const double duration = random.between(0.5, 2.0);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const bool is_moved = random.next() < (i < 3 ? kMovesAlong : kTurns);
      const double goal = random.between(-kFarthest[i], kFarthest[i]);
      if (!is_moved) continue;
      script.segments.push_back({.start_s = time,
                                 .duration_s = duration,
                                 .channel = static_cast<int>(i),
                                 .blend = person::Blend::kBy,
                                 .value = goal - before[i]});
      before[i] = goal;
    }
    time += duration + random.between(0.0, 1.5);
  }
  script.duration_s = time + 1.0;
  play_script(scenario, script);
}

// The joints of the twin at their ends.
class Ends {
 public:
  explicit Ends(const config::Scenario& scenario)
      : twin_(scenario.twin.model.chain),
        end_effector_(scenario.twin.model.end_effector),
        first_(first_joint(scenario.limits)),
        size_(static_cast<int>(scenario.teleoperation->limiter.axes.size())),
        ranges_(scenario.teleoperation->machine.ranges),
        rests_(static_cast<std::size_t>(size_)) {}

  void add(const Sample& now, double dt, RemoteOperationFigures& figures) {
    const CycleRecord& record = now.record;
    twin_.update_kinematics(record.twin.q_a, record.twin.dq_a);
    const auto jacobian = twin_.jacobian(end_effector_);
    for (int i = 0; i < size_; ++i) {
      constexpr double kPressed = 3.0;  // N
      constexpr double kRests = 0.01;   // rad/s
      constexpr double kFor = 0.1;      // s
      const LimitReport& limit = record.limits[static_cast<std::size_t>(first_ + i)];
      const double lever = jacobian.col(i).head<3>().norm();
      const bool is_end =
          limit.cause == LimitCause::kPosition || limit.cause == LimitCause::kBraking;
      const bool presses = is_end && std::abs(limit.reaction) > kPressed * std::max(lever, 0.05);
      double& rest = rests_[static_cast<std::size_t>(i)];
      const bool rests = presses && std::abs(record.twin.dq_a[i]) < kRests;
      const bool is_counted = rest >= kFor;
      rest = rests ? rest + dt : 0.0;
      if (rest < kFor) continue;
      if (!is_counted) ++figures.ends;
      const Interval& range = ranges_[static_cast<std::size_t>(i)];
      const double q = record.twin.q_a[i];
      const double inside = std::min(q - range.lb, range.ub - q);
      figures.felt_early = std::max(figures.felt_early, lever * inside);
      figures.felt_late = std::max(figures.felt_late, -lever * inside);
    }
  }

 private:
  static int first_joint(const LimitCatalogue& catalogue) {
    const auto first = std::ranges::find(catalogue, LimitKind::kTwinJoint, &LimitInfo::kind);
    return static_cast<int>(first - catalogue.begin());
  }

  model::ChainData twin_;
  int end_effector_;
  int first_, size_;
  std::vector<Interval> ranges_;
  std::vector<double> rests_;  ///< since when each is pressed at rest, s
};

// The arm, as its simulation knows it.
class Arm {
 public:
  explicit Arm(const std::vector<Interval>& ranges) : ranges_(ranges) {}

  void add(const Sample& now, double dt, RemoteOperationFigures& figures) {
    const TeleoperationReport& report = now.teleoperation;
    if (report.link == RemoteLink::kEngaged) {
      figures.engaged_s += dt;
      const bool is_held_back =
          report.cause >= RemoteCause::kSpeed && report.cause <= RemoteCause::kForce;
      if (is_held_back) figures.held_back_s += dt;
      if (report.x_true.size() == report.x_leader.size()) {
        const double lag = (report.x_true - report.x_leader).lpNorm<Eigen::Infinity>();
        figures.largest_lag = std::max(figures.largest_lag, lag);
      }
    }
    if (report.link == RemoteLink::kLost && link_ != RemoteLink::kLost) {
      ++figures.stops;
      figures.notes.push_back(fmt::format("the arm held at {:.3f} s, cause {}", now.record.time_s,
                                          static_cast<int>(report.cause)));
    }
    link_ = report.link;
    for (Eigen::Index i = 0; i < report.x_true.size(); ++i) {
      const double x = report.x_true[i];
      const Interval& range = ranges_[static_cast<std::size_t>(i)];
      const double beyond = std::max({0.0, range.lb - x, x - range.ub});
      figures.arm_beyond = std::max(figures.arm_beyond, beyond);
      if (x_.size() == report.x_true.size()) {
        figures.arm_speed = std::max(figures.arm_speed, std::abs(x - x_[i]) / dt);
      }
    }
    x_ = report.x_true;
  }

 private:
  std::vector<Interval> ranges_;
  RemoteLink link_ = RemoteLink::kNone;
  PortVector x_;
};

RemoteOperationFigures operate(config::Scenario scenario, const RemoteOperation& operation,
                               std::uint64_t seed) {
  set_seed(scenario, seed);
  draw_hand(operation, seed, scenario);
  scenario.teleoperation->link.seed = seed;
  const double dt = scenario.device.model.dt();
  Ends ends(scenario);
  Arm arm(scenario.teleoperation->machine.ranges);
  Player player(scenario);
  RemoteOperationFigures figures;
  bool is_played = true;
  while (is_played) {
    player.begin();
    player.run();
    if (player.is_running()) ends.add(player.sample(), dt, figures);
    arm.add(player.sample(), dt, figures);
    is_played = player.end();
  }
  const Fault& fault = player.record().fault;
  if (fault.code != FaultCode::kNone) {
    ++figures.faults;
    figures.notes.push_back(fmt::format("fault {} at {:.3f} s: {}", static_cast<int>(fault.code),
                                        player.record().time_s, to_string(fault.code)));
  }
  for (std::string& text : figures.notes) text = fmt::format("seed {}: {}", seed, text);
  return figures;
}

}  // namespace

void RemoteOperationFigures::add(const RemoteOperationFigures& other) {
  engaged_s += other.engaged_s;
  stops += other.stops;
  faults += other.faults;
  notes.insert(notes.end(), other.notes.begin(), other.notes.end());
  ends += other.ends;
  felt_early = std::max(felt_early, other.felt_early);
  felt_late = std::max(felt_late, other.felt_late);
  arm_beyond = std::max(arm_beyond, other.arm_beyond);
  arm_speed = std::max(arm_speed, other.arm_speed);
  held_back_s += other.held_back_s;
  largest_lag = std::max(largest_lag, other.largest_lag);
}

bool is_good(const RemoteOperationFigures& figures) noexcept {
  return figures.stops == 0 && figures.faults == 0 && figures.felt_early <= kFelt &&
         figures.felt_late <= kFelt;
}

std::vector<RemoteOperationFigures> operate_at_random(const config::Scenario& scenario,
                                                      const RemoteOperation& operation,
                                                      std::uint64_t first, int count,
                                                      const Progress& progress) {
  const auto& teleoperation = scenario.teleoperation;
  if (!teleoperation || teleoperation->mapping != teleoperation::Mapping::kJoints) {
    throw SetupError(scenario.title + " leads no joints of a remote arm; fr3/remote does");
  }
  std::vector<RemoteOperationFigures> runs(static_cast<std::size_t>(count));
  do_all(
      runs.size(), [&](std::size_t i) { runs[i] = operate(scenario, operation, first + i); },
      progress);
  return runs;
}

}  // namespace hg::experiments
