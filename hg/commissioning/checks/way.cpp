#include "hg/commissioning/checks/way.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "hg/controller/rendering/catalogue.h"
#include "hg/model/chain_data.h"
#include "hg/model/joint_range.h"
#include "hg/scenario/session.h"

namespace hg::checks {
namespace {

constexpr double kFirst = 1.0;       // s, from the grasp to the first motion
constexpr double kBeyond = 0.1;      // of a range, how far beyond its ends the hand pulls
constexpr double kRest = 1.0;        // s, at each end
constexpr double kLongest = 20.0;    // s, of one motion
constexpr double kTipSpeed = 0.5;    // m/s, where the twin has no speed limit
constexpr double kTurnSpeed = 1.0;   // rad/s, the same where the handle turns on the spot
constexpr double kSpeedShare = 0.9;  // of the twin's own limits
constexpr double kPullShare = 0.3;   // of what a hand pulls and turns with
constexpr double kAtLimit = 0.1;     // s, from which a limit counts as in the way
constexpr double kNearLever = 0.02;  // m, below it a joint turns the handle on the spot
constexpr double kReached = 0.02;    // share of a range within which an end counts as reached

// Only what moves the device is left of the twin.
void strip(rendering::TwinModel& twin) {
  twin.locks.clear();
  twin.conditional_limits.clear();
  twin.w_ref.setZero();
  for (rendering::TwinDof& dof : twin.dofs) {
    dof.stiffness = dof.preload = dof.friction = dof.quadratic_damping = 0.0;
    dof.closer = {};
  }
}

// The first ones: a script has a channel for each of eight joints.
int led_joints(const rendering::TwinModel& twin) {
  return std::min(person::kPoseChannels, static_cast<int>(twin.dofs.size()));
}

Interval range_of(const rendering::TwinDof& dof) {
  return model::finite_range({dof.limits.q_min, dof.limits.q_max}, dof.is_angle);
}

// Duration of a minimum-jerk motion over `way` that joint `dof` and a hand can follow, s.
double duration_of(const rendering::TwinModel& twin, const person::HandImpedance& hand,
                   model::ChainData& chain, int dof, double way) {
  const rendering::TwinDof& joint = twin.dofs[dof];
  const model::Jacobian J = chain.jacobian(twin.end_effector);
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
  return std::clamp(std::max(by_speed, by_acceleration), 0.5, kLongest);
}

// Each joint from its start to its upper end, to its lower end, and back to the start. As people
// do, the hand pulls on at an end.
person::Script script_through(const rendering::TwinModel& twin, const person::HandImpedance& hand) {
  model::ChainData chain(twin.chain);
  chain.update(twin.q_start, VectorA::Zero(twin.chain.nv()));
  person::Script script = {.frame = person::ScriptFrame::kTwinJoints};
  script.start[person::kGripChannel] = 1.0;
  double t = kFirst;
  for (int i = 0; i < led_joints(twin); ++i) {
    const Interval range = range_of(twin.dofs[i]);
    double at = twin.q_start[twin.dofs[i].q_index];
    const double beyond = kBeyond * (range.ub - range.lb);
    for (const double to : {range.ub + beyond, range.lb - beyond, at}) {
      const double duration = duration_of(twin, hand, chain, i, std::abs(to - at));
      script.segments.push_back({t, duration, i, person::Blend::kTo, to});
      t += duration + kRest;
      at = to;
    }
  }
  script.duration_s = t;
  return script;
}

config::Scenario scenario_of(const config::SimulatedDeviceConfig& device,
                             const config::Twin& twin) {
  config::Scenario scenario = {.title = {},
                               .description = {},
                               .device = device,
                               .twin = twin,
                               .person = person::PersonKind::kScript,
                               .script = {},
                               .limits = {},
                               .events = {},
                               .changes = {},
                               .sources = {},
                               .places = {}};
  strip(scenario.twin.model);
  scenario.limits = rendering::make_catalogue(device.model, scenario.twin.model);
  scenario.changes.push_back({0.0, {Parameter::kGravity, -1, 0.0}});
  scenario.script.hand.tremor_rms = 0.0;
  scenario.script.script = script_through(scenario.twin.model, scenario.script.hand);
  return scenario;
}

// Follows a trial from cycle to cycle.
class Watch {
 public:
  explicit Watch(const config::Scenario& scenario)
      : scenario_(scenario),
        positions_(scenario.device.model),
        at_limit_s_(scenario.device.model.limit_count()) {
    const ConfigurationA& start = scenario.twin.model.q_start;
    for (const rendering::TwinDof& dof : scenario.twin.model.dofs) {
      const double q = start[dof.q_index];
      reached_.push_back({q, q});
    }
  }

  void look(const Sample& sample) {
    if (sample.record.mode != Mode::kRunning) return;
    const std::vector<rendering::TwinDof>& dofs = scenario_.twin.model.dofs;
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      const double q = sample.record.twin.q_a[dofs[i].q_index];
      reached_[i] = {std::min(reached_[i].lb, q), std::max(reached_[i].ub, q)};
    }
    look_at_limits(sample.record);
    look_at_truth(sample.truth);
  }

  Way result(const CycleRecord& last) {
    if (last.mode == Mode::kFault) way_.fault = to_string(last.fault.code);
    const std::vector<rendering::TwinDof>& dofs = scenario_.twin.model.dofs;
    for (int i = 0; i < led_joints(scenario_.twin.model); ++i) {
      const Interval range = range_of(dofs[i]);
      const double reached = (reached_[i].ub - reached_[i].lb) / (range.ub - range.lb);
      const double share = std::min(1.0, reached + kReached);
      if (share >= way_.share && i > 0) continue;
      way_.share = share;
      way_.twin_joint = dofs[i].name;
    }
    return std::move(way_);
  }

 private:
  void look_at_limits(const CycleRecord& record) {
    for (std::size_t i = 0; i < at_limit_s_.size(); ++i) {
      const LimitReport& limit = record.limits[i];
      const bool is_at_end =
          limit.state != LimitState::kInactive && limit.cause == LimitCause::kPosition;
      at_limit_s_[i] = is_at_end ? at_limit_s_[i] + scenario_.device.model.dt() : 0.0;
      if (at_limit_s_[i] < kAtLimit || at_limit_s_[i] <= way_.at_limit_s) continue;
      way_.at_limit_s = at_limit_s_[i];
      way_.limit = scenario_.limits[i].name;
    }
  }

  void look_at_truth(const Truth& truth) {
    positions_.find(truth.q_p, truth.q_m, values_);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const Interval& range = scenario_.limits[i].range;
      const double excess = std::max(range.lb - values_[i], values_[i] - range.ub);
      if (!(excess > std::max(kExcessAllowed, way_.excess))) continue;
      way_.excess = excess;
      way_.exceeded = scenario_.limits[i].name;
    }
  }

  const config::Scenario& scenario_;
  rendering::LimitPositions positions_;
  std::vector<double> at_limit_s_, values_;
  std::vector<Interval> reached_;
  Way way_;
};

}  // namespace

std::string trouble_of(const Way& way) {
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
  if (!way.exceeded.empty()) {
    add(fmt::format("{} of the device leaves its limit by {:.1f} mm or mrad", way.exceeded,
                    1e3 * way.excess));
  }
  return text.empty() ? text : "led through its whole range by a hand: " + text;
}

Way lead(const config::SimulatedDeviceConfig& device, const config::Twin& twin) {
  const bool can_be_led = std::ranges::all_of(
      twin.model.dofs, [](const rendering::TwinDof& dof) { return dof.q_index >= 0; });
  if (!can_be_led) return {};
  const config::Scenario scenario = scenario_of(device, twin);
  scenario::Session session(scenario);
  Watch watch(scenario);
  while (session.advance()) watch.look(session.sample());
  return watch.result(session.record());
}

}  // namespace hg::checks
