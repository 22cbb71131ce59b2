#include "hg/start_test/device_station.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "hg/core/stacked.h"
#include "hg/runtime/requests.h"

namespace hg::start_test {
namespace {

constexpr std::uint64_t kResetEdge = 50;  // cycles between a request and the pause before the next

bool is_gone(FaultCode code) {
  return code == FaultCode::kDeviceSilent || code == FaultCode::kDeviceGone ||
         code == FaultCode::kCommandsLost;
}

}  // namespace

Setup setup_of(const config::DeviceConfig& device, bool is_simulated) {
  constexpr double kOverFriction = 2.0;
  constexpr double kTorque = 1.0, kForce = 10.0;  // where friction is unknown
  constexpr double kGantryTorque = 5.0, kGantryForce = 20.0;
  Setup setup = {.config = device.start_test, .is_simulated = is_simulated};
  const std::vector<model::Joint>& joints = device.model.chain.joints();
  const std::vector<ActuatorModel>& actuators = device.model.actuators;
  for (int i = 0; i < device.model.n_p + device.model.n_m; ++i) {
    const model::Joint& joint = joints[i];
    const bool is_slide = joint.is_slide();
    const bool is_gantry = i < device.model.n_p;
    double least = is_slide ? kForce : kTorque;
    if (is_gantry) least = is_slide ? kGantryForce : kGantryTorque;
    if (!is_gantry && !actuators.empty()) {
      const ActuatorModel& actuator = actuators[i - device.model.n_p];
      least = std::max(least, kOverFriction * actuator.stiction * actuator.coulomb_friction);
    }
    (is_gantry ? setup.gantry : setup.manipulator).push_back({joint.name, is_slide, least});
  }
  return setup;
}

DeviceStation::DeviceStation(const config::Scenario& scenario,
                             std::unique_ptr<device::Device> device, bool is_simulated,
                             const std::atomic<bool>& interrupted, Print print)
    : session_(scenario, std::move(device)),
      model_(scenario.device.model),
      chain_(scenario.device.model.chain),
      is_simulated_(is_simulated),
      interrupted_(interrupted),
      print_(std::move(print)) {}

Observation DeviceStation::advance(Wish wish) {
  Sample& sample = session_.sample();
  session_.read();
  sample.operator_input.request = request(wish);
  session_.step();
  const Observation seen = observe(wish);
  if (is_simulated_) {
    operator_.operate(sample.sensors.time_s, chain_.pose(model_.handle), sample.command);
  }
  const bool has_gone = is_gone(sample.sensors.driver_fault);
  if (has_gone || interrupted_.load()) {
    if (has_gone) end_ = sample.sensors.driver_fault;
    release();
    throw Ended{has_gone ? std::string(to_string(end_)) : "interrupted"};
  }
  session_.write();
  return seen;
}

void DeviceStation::prompt(Act act, const std::string& words) {
  report("-> " + words);
  operator_.prompt(act);
}

void DeviceStation::report(const std::string& words) {
  print_(session_.sample().sensors.time_s, words);
}

void DeviceStation::release() {
  disable(session_.sample().command);
  session_.write();
}

// By the record of the last cycle; requests act on their edge. What was armed is never reset.
ModeRequest DeviceStation::request(Wish wish) const {
  const CycleRecord& record = session_.record();
  const bool is_pause = record.cycle / kResetEdge % 2 == 0;
  if (wish == Wish::kStay) return ModeRequest::kNone;
  if (record.mode == Mode::kFault) {
    return wish != Wish::kTare || is_pause ? ModeRequest::kNone : ModeRequest::kReset;
  }
  if (record.mode == Mode::kReady && wish != Wish::kOff) {
    const bool is_held = session_.cycle().is_held(session_.sample().sensors);
    const ModeRequest next = runtime::next_request(record, is_held, false);
    if (next == ModeRequest::kArm && (wish != Wish::kArm || is_pause)) return ModeRequest::kNone;
    return next;
  }
  return wish != Wish::kArm && record.mode == Mode::kArmed ? ModeRequest::kStop
                                                           : ModeRequest::kNone;
}

Observation DeviceStation::observe(Wish wish) {
  const SensorFrame& sensors = session_.sample().sensors;
  const CycleRecord& record = session_.record();
  const RobotState& robot = record.robot;
  Observation seen = {.time_s = sensors.time_s,
                      .safety = sensors.safety,
                      .dead_man = sensors.dead_man,
                      .load_m = VectorM::Zero(model_.n_m),
                      .load_p = VectorP::Zero(model_.n_p),
                      .is_powered = session_.sample().command.enable,
                      .mode = record.mode,
                      .fault = record.fault.code,
                      .refusal = record.refusal};
  if (wish == Wish::kArm && !record.is_tared) seen.refusal = Refusal::kNotTared;
  if (robot.q_m.size() != model_.n_m) return seen;  // the sample was invalid
  const bool has_motor_side = robot.theta_m.size() == model_.n_m;
  if (had_motor_side_ && !has_motor_side) return seen;  // and so is this one: another side
  had_motor_side_ = has_motor_side;
  seen.q_m = has_motor_side ? robot.theta_m : robot.q_m;
  seen.q_p = sensors.q_p;
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(model_.n_p + model_.n_m);
  chain_.update(stacked(sensors.q_p, robot.q_m), at_rest);
  const Eigen::VectorXd user = chain_.jacobian(model_.handle).transpose() * robot.w_H;
  const Eigen::VectorXd load = chain_.gravity() - user;
  seen.load_p = load.head(model_.n_p);
  seen.load_m = robot.tau_m.size() == model_.n_m ? robot.tau_m : VectorM(load.tail(model_.n_m));
  return seen;
}

}  // namespace hg::start_test
