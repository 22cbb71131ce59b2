#include "hg/scenario/way_to_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "hg/controller/safety/monitor.h"
#include "hg/core/error.h"
#include "hg/core/rotation.h"
#include "hg/core/stacked.h"
#include "hg/model/chain_data.h"
#include "hg/runtime/requests.h"
#include "hg/signals/fault.h"

namespace hg::scenario {
namespace {

constexpr double kSpeed = 0.25, kTurnSpeed = 0.5;   // m/s, rad/s, of each joint
constexpr double kRating = 0.5, kTurnRating = 1.0;  // m/s^2, rad/s^2
constexpr double kFrequency = 3.0;                  // rad/s, of each joint on its spring
constexpr double kNear = 3e-3, kTurnNear = 5e-3;    // m, rad: the handle is there
constexpr double kRest = 2e-2;                      // m/s and rad/s; above the noise of encoders
constexpr double kStill = 0.2;                      // s
constexpr double kRepeated = 0.3;                   // s between two requests

constexpr double kLoad = 5.0, kTurnLoad = 1.0;  // kg, kg m^2, at the handle

// The device as a mechanism without weight. It carries a load at its handle, so that the springs
// of light joints are stiff, too: errors of the force sensor then move it by less than kNear.
model::ChainModel mechanism(const config::DeviceConfig& device) {
  model::ChainOptions options = device.chain_options;
  options.gravity = false;
  if (!options.tool) {
    options.tool = {.link = device.model.chain.frame_names()[device.model.handle],
                    .handle = "load",
                    .T_link_handle = {}};
  }
  options.tool->mass += kLoad;
  options.tool->inertia += kTurnLoad * Eigen::Matrix3d::Identity();
  const auto urdf =
      std::ranges::find(device.sources, device.urdf.string(), &config::SourceText::name);
  if (urdf == device.sources.end()) {
    return model::ChainModel::from_urdf_file(device.urdf, options);
  }
  return model::ChainModel::from_urdf_text(urdf->content, urdf->name, options);
}

// Goal of a joint, the nearest one where whole turns do not matter.
double goal_of(const model::Joint& joint, double now, double goal) {
  if (joint.type != model::JointType::kContinuous) return goal;
  return now + std::remainder(goal - now, 2.0 * std::numbers::pi);
}

// A joint of the mechanism on its critically damped spring; `mass` is its inertia, kg m^2 or kg.
rendering::TwinDof dof_of(const model::Joint& joint, double mass, double goal) {
  const bool is_slide = joint.is_slide();
  return {.name = joint.name + " on its way",
          .q_index = joint.q_index,
          .is_angle = !is_slide,
          .limits = {.dq_max = is_slide ? kSpeed : kTurnSpeed,
                     .ddq_max = is_slide ? kRating : kTurnRating},
          .stiffness = mass * kFrequency * kFrequency,
          .rest = goal,
          .damping = 2.0 * mass * kFrequency};
}

config::Twin twin_of(const config::DeviceConfig& device, const Start& start,
                     const ConfigurationA& q) {
  config::Twin twin = {.name = "way to the start",
                       .urdf = {},
                       .T_B_root = {},
                       .model = {.chain = mechanism(device),
                                 .end_effector = device.model.handle,
                                 .q_start = q,
                                 .dofs = {},
                                 .locks = {},
                                 .conditional_limits = {},
                                 .spheres = {},
                                 .mass_scale = rendering::kMassScale.ub},
                       .sources = {},
                       .places = {}};
  model::ChainData chain(twin.model.chain);
  const VectorPM goal = stacked(start.q_p, start.q_m);
  chain.update(goal, VectorA::Zero(chain.model().nv()));
  const double mass_scale = twin.model.mass_scale;
  for (const model::Joint& joint : twin.model.chain.joints()) {
    const int i = joint.v_index;
    twin.model.dofs.push_back(
        dof_of(joint, mass_scale * chain.M()(i, i), goal_of(joint, q[i], goal[i])));
  }
  return twin;
}

double largest(const auto& values) noexcept {
  return values.size() == 0 ? 0.0 : values.cwiseAbs().maxCoeff();
}

}  // namespace

config::Scenario way_to_start(const config::Scenario& run, const Start& start, const VectorP& q_p,
                              const VectorM& q_m) {
  config::Scenario way = run;
  way.title = run.title + ", on the way to its start";
  way.description = "The device moves alone to where the run begins: keep off the handle.";
  way.duration_s = 0.0;
  way.twin = twin_of(run.device, start, stacked(q_p, q_m));
  way.person = person::PersonKind::kNone;
  way.events.clear();
  way.changes.clear();
  way.panel.clear();
  way.faults.clear();
  way.surfaces.clear();
  config::settle_law(way);
  return way;
}

void WayGuide::observe(const Sample& sample) {
  const CycleRecord& record = last_ = sample.record;
  safety_ = sample.sensors.safety;
  is_held_ = safety::is_held(way_.device.monitor, sample.sensors);
  distance_ = (record.T_B_H.p - start_.T_B_H.p).norm();
  angle_ = angle_between(record.T_B_H.R, start_.T_B_H.R);
  if (record.robot.q_p.size() == start_.q_p.size()) {
    gantry_distance_ = largest(VectorP(record.robot.q_p - start_.q_p));
  }
  const bool is_near = distance_ < kNear && angle_ < kTurnNear;
  const bool is_at_rest = largest(record.robot.dq_m) < kRest && largest(record.robot.dq_p) < kRest;
  const bool is_moving_alone = record.mode == Mode::kRunning && record.is_autonomous;
  if (!is_moving_alone || !is_near || !is_at_rest) still_since_s_ = -1.0;
  if (is_moving_alone && is_near && is_at_rest && still_since_s_ < 0.0) {
    still_since_s_ = record.time_s;
  }
  is_there_ = is_there_ || (still_since_s_ >= 0.0 && record.time_s > still_since_s_ + kStill);
  look_for_stop(sample);
  has_moved_ = has_moved_ || is_moving_alone;
}

void WayGuide::end(std::string cause) {
  if (!is_over()) cause_ = std::move(cause);
}

// What ends the way before the handle is there.
void WayGuide::look_for_stop(const Sample& sample) {
  const CycleRecord& record = sample.record;
  if (record.fault.code != FaultCode::kNone) {
    end(fmt::format("{} {}", static_cast<int>(record.fault.code), to_string(record.fault.code)));
  } else if (record.mode == Mode::kRunning && !record.is_autonomous) {
    end("it was asked to run by hand");
  } else if (has_moved_ && record.mode != Mode::kRunning) {
    if (!safety_.override_key) {
      end("the override key was turned off");
    } else if (is_held_) {
      end("a hand took hold of the handle");
    } else {
      end("it was stopped");
    }
  }
}

ModeRequest WayGuide::request() {
  if (is_over() || last_.time_s < asked_at_s_ + kRepeated) return ModeRequest::kNone;
  ModeRequest next = ModeRequest::kNone;
  if (last_.mode == Mode::kReady) next = runtime::next_request(last_, is_held_, false);
  if (last_.mode == Mode::kArmed && wanted().empty()) next = ModeRequest::kAutonomous;
  if (next != ModeRequest::kNone) asked_at_s_ = last_.time_s;
  return next;
}

std::string WayGuide::wanted() const {
  if (has_moved_ || (last_.mode != Mode::kArmed && last_.mode != Mode::kReady)) return {};
  if (is_held_) return "let go of the handle: the device moves to the start alone";
  if (!safety_.is_field_clear) return "leave the field of the scanner";
  if (!safety_.override_key) {
    return "turn the override key on: the device moves to the start alone; keep clear";
  }
  return {};
}

std::string WayGuide::problem() const {
  if (is_there_) return {};
  if (!cause_.empty()) return cause_;
  if (!has_moved_) {
    const std::string waited_for = wanted();
    if (!waited_for.empty()) return "it has not begun: " + waited_for;
    const Refusal refusal = last_.refusal;
    return refusal == Refusal::kNone ? "it has not begun"
                                     : fmt::format("it has not begun: {}", to_string(refusal));
  }
  return fmt::format("it did not arrive: the handle is still {:.1f} mm and {:.1f} mrad away",
                     1e3 * distance_, 1e3 * angle_);
}

}  // namespace hg::scenario
