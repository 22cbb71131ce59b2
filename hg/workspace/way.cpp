#include "hg/workspace/way.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/rendering/catalogue.h"
#include "hg/controller/rendering/twin_elements.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/session.h"

namespace hg::workspace {
namespace {

constexpr double kFirst = 1.0;       // s, from the grasp to the first motion
constexpr double kBeyond = 0.1;      // of a range, how far beyond its ends the hand pulls
constexpr double kRest = 1.0;        // s, at each end
constexpr double kSlow = 4.0;        // times the shortest duration, back to the start
constexpr double kCalm = 0.4;        // of the largest speed, in the second trial
constexpr double kShortest = 0.5;    // s, of one motion
constexpr double kLongest = 60.0;    // s, of one motion: a joint that takes longer is not led
constexpr double kCoasting = 1.5;    // s, time constant of a twin that is let go
constexpr double kTipSpeed = 0.5;    // m/s, where the twin has no speed limit
constexpr double kTurnSpeed = 1.0;   // rad/s, the same where the handle turns on the spot
constexpr double kSpeedShare = 0.9;  // of the twin's own limits
constexpr double kPullShare = 0.3;   // of what a hand pulls and turns with
constexpr double kAtLimit = 0.1;     // s, from which a limit counts as in the way
constexpr double kAtSpeed = 0.2;     // s, the same for the largest speed of a joint
constexpr double kReached = 0.02;    // share of a range within which an end counts as reached
constexpr double kPlaces = 0.05;     // share of a range between two places
constexpr double kAtEnd = 0.002;     // the same, from an end of it

// Only what moves the device is left of the twin. It coasts, so that the hand has hardly to pull.
// `chain` is the twin at its start.
void strip(rendering::TwinModel& twin, model::ChainData& chain) {
  rendering::leave_out_forces(twin);
  const Eigen::MatrixXd& M = chain.M();
  for (int i = 0; i < std::ssize(twin.dofs); ++i) twin.dofs[i].damping = M(i, i) / kCoasting;
}

// Duration of a minimum-jerk motion over `way` that joint `dof` and a hand can follow, s.
// `chain` is the twin at its start.
double duration_of(const rendering::TwinModel& twin, const person::HandImpedance& hand,
                   model::ChainData& chain, int dof, double way) {
  const rendering::TwinDof& joint = twin.dofs[dof];
  const model::Jacobian& J = chain.jacobian(twin.end_effector);
  const double lever = J.col(dof).head<3>().norm();
  const bool is_on_the_spot = lever < kNearLever;
  const double speed =
      std::min(joint.limits.dq_max, is_on_the_spot ? kTurnSpeed : kTipSpeed / lever);
  const double pull = is_on_the_spot ? hand.torque_max : hand.force_max * lever;
  const double acceleration =
      std::min(kSpeedShare * joint.limits.ddq_max, kPullShare * pull / chain.M()(dof, dof));
  // minimum jerk: peak speed 1.875 way / T, peak acceleration 5.77 way / T^2
  const double by_speed = 1.875 * way / (kSpeedShare * speed);
  const double by_acceleration = std::sqrt(5.77 * way / acceleration);
  return std::max({by_speed, by_acceleration, kShortest});
}

// Joints that have a range through which they can be led in time.
std::vector<int> led_joints(const rendering::TwinModel& twin, const person::HandImpedance& hand,
                            model::ChainData& chain) {
  std::vector<int> led;
  for (int i = 0; i < std::ssize(twin.dofs); ++i) {
    const limits::JointLimits& limits = twin.dofs[i].limits;
    const double range = limits.q_max - limits.q_min;
    if (range > 0.0 && std::isfinite(range) && duration_of(twin, hand, chain, i, range) < kLongest)
      led.push_back(i);
  }
  return led;
}

// Each joint from its start to its upper end, to its lower end, and slowly back to the start, where
// drives stick and slip. As people do, the hand pulls on at an end. `pace`: share of the largest
// speed.
person::Script script_through(const rendering::TwinModel& twin, const person::HandImpedance& hand,
                              const std::vector<int>& led, double pace, model::ChainData& chain) {
  person::Script script = {.frame = person::ScriptFrame::kTwinJoints};
  script.start[person::kGripChannel] = 1.0;
  double t = kFirst;
  for (const int dof : led) {
    const limits::JointLimits& limits = twin.dofs[dof].limits;
    const double start = twin.q_start[twin.dofs[dof].q_index];
    const double beyond = kBeyond * (limits.q_max - limits.q_min);
    double at = start;
    for (const double to : {limits.q_max + beyond, limits.q_min - beyond, start}) {
      const double fastest = duration_of(twin, hand, chain, dof, std::abs(to - at));
      const double paced = std::max(fastest, std::min(fastest / pace, kLongest));
      const double duration = to == start ? kSlow * fastest : paced;
      script.segments.push_back({t, duration, dof, person::Blend::kTo, to});
      t += duration + kRest;
      at = to;
    }
  }
  script.duration_s = t;
  return script;
}

// Whether the coordinates of a script can be those of the twin.
bool has_script(const rendering::TwinModel& twin) {
  const bool is_floating =
      std::ranges::any_of(twin.dofs, [](const rendering::TwinDof& dof) { return dof.q_index < 0; });
  return !is_floating && std::ssize(twin.dofs) <= person::kPoseChannels;
}

// A trial: its scenario, and the joints of the twin that are led.
struct Trial {
  config::Scenario scenario;
  std::vector<int> led;
};

Trial make_trial(const config::SimulatedDeviceConfig& device, const config::Twin& twin,
                 double pace) {
  Trial trial = {.scenario = {.title = {},
                              .description = {},
                              .device = device,
                              .twin = twin,
                              .person = person::PersonKind::kScript,
                              .script = {},
                              .limits = {},
                              .events = {},
                              .changes = {},
                              .sources = {},
                              .places = {}},
                 .led = {}};
  config::Scenario& scenario = trial.scenario;
  rendering::TwinModel& model = scenario.twin.model;
  model::ChainData chain(model.chain);
  chain.update(model.q_start, VectorA::Zero(model.chain.nv()));
  strip(model, chain);
  scenario.limits = rendering::make_catalogue(device.model, model);
  scenario.changes.push_back({0.0, {Parameter::kGravity, -1, 0.0}});
  const person::HandImpedance& hand = scenario.script.hand;
  trial.led = led_joints(model, hand, chain);
  scenario.script.script = script_through(model, hand, trial.led, pace, chain);
  return trial;
}

// Follows a trial from cycle to cycle.
class Watch {
 public:
  explicit Watch(const Trial& trial)
      : trial_(trial),
        positions_(trial.scenario.device.model),
        at_limit_s_(trial.scenario.device.model.limit_count()),
        at_speed_s_(at_limit_s_.size()) {
    for (const int dof : trial.led) {
      const double q = position(trial.scenario.twin.model.q_start, dof);
      reached_.push_back({q, q});
    }
    way_.led = trial.led;
  }

  void look(const Sample& sample) {
    if (sample.record.mode != Mode::kRunning) return;
    for (int i = 0; i < std::ssize(trial_.led); ++i) {
      const double q = position(sample.record.twin.q_a, trial_.led[i]);
      reached_[i] = {std::min(reached_[i].lb, q), std::max(reached_[i].ub, q)};
    }
    if (sample.record.warning.code == FaultCode::kOscillation) {
      way_.shaken_s += trial_.scenario.device.model.dt();
    }
    look_at_limits(sample.record);
    look_at_truth(sample.truth);
    note_place(sample);
  }

  Way result(const CycleRecord& last) {
    if (last.mode == Mode::kFault) way_.fault = to_string(last.fault.code);
    for (int i = 0; i < std::ssize(trial_.led); ++i) {
      const rendering::TwinDof& dof = trial_.scenario.twin.model.dofs[trial_.led[i]];
      const double range = dof.limits.q_max - dof.limits.q_min;
      const double share = std::min(1.0, (reached_[i].ub - reached_[i].lb) / range + kReached);
      if (share >= way_.share) continue;
      way_.share = share;
      way_.twin_joint = dof.name;
    }
    return std::move(way_);
  }

 private:
  double position(const ConfigurationA& q, int dof) const {
    return q[trial_.scenario.twin.model.dofs[dof].q_index];
  }

  // Adds a period to the time for which limit `i` has been in a state, and keeps the longest.
  void count(bool is_so, std::size_t i, double shortest, std::vector<double>& so_far_s,
             double& longest_s, std::string& name) const {
    so_far_s[i] = is_so ? so_far_s[i] + trial_.scenario.device.model.dt() : 0.0;
    if (so_far_s[i] < shortest || so_far_s[i] <= longest_s) return;
    longest_s = so_far_s[i];
    name = trial_.scenario.limits[i].name;
  }

  void look_at_limits(const CycleRecord& record) {
    for (std::size_t i = 0; i < at_limit_s_.size(); ++i) {
      const LimitReport& limit = record.limits[i];
      const bool acts = limit.state != LimitState::kInactive;
      count(acts && limit.cause == LimitCause::kPosition, i, kAtLimit, at_limit_s_, way_.at_limit_s,
            way_.limit);
      if (trial_.scenario.limits[i].kind != LimitKind::kManipulatorJoint) continue;
      count(acts && limit.cause == LimitCause::kVelocity, i, kAtSpeed, at_speed_s_, way_.rushed_s,
            way_.rushed);
    }
  }

  void note_place(const Sample& sample) {
    const ConfigurationA& q_a = sample.record.twin.q_a;
    const auto is_far = [&](int dof) {
      const limits::JointLimits& limits = trial_.scenario.twin.model.dofs[dof].limits;
      const double range = limits.q_max - limits.q_min;
      const double q = position(q_a, dof), last = position(way_.places.back().q_a, dof);
      const auto is_at_end = [&](double at) {
        return std::min(at - limits.q_min, limits.q_max - at) < kAtEnd * range;
      };
      return std::abs(q - last) >= kPlaces * range || (is_at_end(q) && !is_at_end(last));
    };
    if (!way_.places.empty() && std::ranges::none_of(trial_.led, is_far)) return;
    way_.places.push_back({stacked(sample.truth.q_p, sample.truth.q_m), q_a});
  }

  void look_at_truth(const Truth& truth) {
    positions_.find(truth.q_p, truth.q_m, values_);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const Interval& range = trial_.scenario.limits[i].range;
      const double excess = std::max(range.lb - values_[i], values_[i] - range.ub);
      if (!(excess > std::max(kExcessAllowed, way_.excess))) continue;
      way_.excess = excess;
      way_.exceeded = trial_.scenario.limits[i].name;
    }
  }

  const Trial& trial_;
  rendering::LimitPositions positions_;
  std::vector<double> at_limit_s_, at_speed_s_, values_;
  std::vector<Interval> reached_;
  Way way_;
};

}  // namespace

std::string problem_of(const Way& way) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  if (way.share < kWholeWay) {
    add(fmt::format("{} comes through {:.0f} % of its range", way.twin_joint, 100.0 * way.share));
  }
  if (!way.fault.empty()) add("the trial ends in a fault, " + way.fault);
  if (!way.limit.empty()) {
    add(fmt::format("{} of the device stands at its limit for {:.1f} s", way.limit,
                    way.at_limit_s));
  }
  if (!way.rushed.empty()) {
    add(fmt::format("{} of the device moves at its largest speed for {:.1f} s", way.rushed,
                    way.rushed_s));
  }
  if (!way.exceeded.empty()) {
    add(fmt::format("{} of the device leaves its limit by {:.1f} mm or mrad", way.exceeded,
                    1e3 * way.excess));
  }
  if (way.shaken_s > 0.0) {
    add(fmt::format("hand and device oscillate against each other for {:.1f} s", way.shaken_s));
  }
  return text.empty() ? text : "led through its whole range by a hand: " + text;
}

bool take_script_through_ranges(config::Scenario& scenario) {
  const rendering::TwinModel& twin = scenario.twin.model;
  if (!has_script(twin)) return false;
  const person::HandImpedance& hand = scenario.script.hand;
  model::ChainData chain(twin.chain);
  chain.update(twin.q_start, VectorA::Zero(twin.chain.nv()));
  const std::vector<int> led = led_joints(twin, hand, chain);
  if (led.empty()) return false;
  scenario.script.script = script_through(twin, hand, led, 1.0, chain);
  return true;
}

Way lead(const config::SimulatedDeviceConfig& device, const config::Twin& twin) {
  if (!has_script(twin.model)) return {};
  // a joint to spare takes another way at another speed
  Way way;
  for (const double pace : {1.0, kCalm}) {
    const Trial trial = make_trial(device, twin, pace);
    scenario::Session session(trial.scenario);
    Watch watch(trial);
    while (session.advance()) watch.look(session.sample());
    way = watch.result(session.record());
    if (!problem_of(way).empty()) break;
  }
  return way;
}

}  // namespace hg::workspace
