#include "hg/experiments/haptify/play.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "hg/controller/rendering/catalogue.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/place.h"
#include "hg/experiments/player.h"
#include "hg/scenario/assembly.h"

namespace hg::haptify {
namespace {

// Of a free body: the force of the surface, as far as limits do not take from it, times the way
// along it. What limits do to the rest of the motion is not the wall's.
double contact_power(const CycleRecord& record, double period) {
  const Budget& budget = record.budget;
  if (record.contact.surface < 0) return 0.0;
  const Eigen::Vector3d surface = -budget.surface.head<3>();
  const double force = surface.norm();
  if (force == 0.0) return 0.0;
  const Eigen::Vector3d along = surface / force;
  const double taken = along.dot((budget.limits + budget.conflict).head<3>());
  const VectorA dq = record.twin.dq_a + 0.5 * period * record.twin.ddq_a;
  return std::clamp(force - taken, 0.0, force) * along.dot(dq.head<3>());
}

double torque_share(const VectorM& of_joints) {
  return of_joints.size() > 0 ? of_joints.maxCoeff() : 0.0;
}

// Whether a device whose place was found has come to the end of a range: what is felt there is that
// limit, not what was to be measured.
class EndOfRange {
 public:
  explicit EndOfRange(const config::Scenario& scenario)
      : is_looking_(!scenario.device.model.has_closed_form),
        limits_(scenario.limits),
        limit_positions_(scenario.device.model) {}

  void look(const CycleRecord& record, const Truth& truth) {
    if (!is_looking_ || !limit_.empty() || record.felt_limit < 0) return;
    constexpr double kNear = 0.01;  // of a range
    limit_positions_.find(truth.q_p, truth.q_m, positions_);
    const auto felt = static_cast<std::size_t>(record.felt_limit);
    if (felt >= positions_.size()) return;
    const Interval& range = limits_[felt].range;
    const double near = kNear * (range.ub - range.lb);
    if (!std::isfinite(near)) return;
    const bool is_inside = positions_[felt] > range.lb + near && positions_[felt] < range.ub - near;
    if (!is_inside) limit_ = limits_[felt].name;
  }

  const std::string& limit() const { return limit_; }

 private:
  bool is_looking_;
  LimitCatalogue limits_;
  rendering::LimitPositions limit_positions_;
  std::vector<double> positions_;
  std::string limit_;
};

}  // namespace

config::Scenario with_script(config::Scenario scenario, const person::Script& script) {
  experiments::play_script(scenario, script);
  scenario.script.script.start[person::kGripChannel] = 1.0;
  scenario.events.clear();
  return scenario;
}

Played play(const config::Scenario& scenario, const Disturbance& disturbance) {
  experiments::Player player(scenario);
  analysis::Summary summary = scenario::make_summary(scenario);
  const double grasp_s = scenario.script.script.grasp_s;
  EndOfRange end(scenario);
  Played played;
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    player.run();
    if (disturbance && player.is_running()) {
      disturbance(player.record().time_s, player.command().dq_p);
    }
    const Sample& sample = player.sample();
    summary.add(sample);
    const CycleRecord& record = sample.record;
    if (record.time_s < grasp_s) continue;
    const Truth& truth = sample.truth;
    end.look(record, truth);
    played.instants.push_back(
        {.time_s = record.time_s - grasp_s,
         .T_B_H = truth.T_B_H,
         .twist = truth.twist,
         .acceleration = truth.acceleration,
         .w_H = truth.w_H,
         .p_B_E = record.T_B_E.p,
         .p_ref = record.T_B_H.p,
         .surface = record.contact.force,
         .contact_power = contact_power(record, 1.0 / scenario.device.model.rate_Hz),
         .q_p = truth.q_p,
         .dq_p = truth.dq_p,
         .q_m = truth.q_m,
         .dq_m = truth.dq_m,
         .is_limited = record.felt_limit >= 0,
         .joint_error = (record.reference.q_m - truth.q_m).cwiseAbs().maxCoeff(),
         .torque_share = torque_share(record.tracking.torque_share)});
  }
  const Fault& fault = player.record().fault;
  if (fault.code != FaultCode::kNone) {
    played.failure = fmt::format("fault {} ({}) at {:.2f} s", static_cast<int>(fault.code),
                                 to_string(fault.code), player.record().time_s);
  } else if (!player.is_running()) {
    played.failure = "the device did not run";
  } else if (!summary.limits_held()) {
    played.failure = "a limit was exceeded";
  } else if (!end.limit().empty()) {
    played.failure = experiments::kNotPossible + ("the way ends at a limit, " + end.limit());
  }
  return played;
}

}  // namespace hg::haptify
