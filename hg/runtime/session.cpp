#include "hg/runtime/session.h"

#include <utility>

#include "hg/controller/cycle.h"
#include "hg/controller/cycle_state.h"
#include "hg/runtime/requests.h"

namespace hg::runtime {

Session::Session(controller::Cycle& cycle, device::Device& device, const SessionPlan& plan)
    : cycle_(cycle),
      device_(device),
      duration_s_(plan.duration_s),
      changes_(plan.changes),
      loads_(plan.load),
      twin_force_(plan.twin_force),
      twin_base_(plan.twin_base) {}

bool Session::advance() noexcept HG_NONBLOCKING {
  read();
  step();
  write();
  return !is_over() && !has_played();
}

void Session::read() noexcept HG_NONBLOCKING {
  Sample& now = *sample_;
  OperatorFrame& input = now.operator_input;
  const double time_s = cycle_.time_s();
  input = next_;
  // of the automatic operator: by what the last period showed
  if (!std::exchange(is_asked_, is_operated_) || is_stopping_) {
    input.request = next_request(now.record, cycle_.is_held(now.sensors), is_stopping_);
  }
  const ParameterChange due = changes_.due(time_s);
  if (due.parameter != Parameter::kNone) {
    input.change = due;
  } else {
    next_.change = {};
  }
  input.late_cycles += loads_.late_cycles(time_s);
  if (twin_force_ != nullptr) {
    twin_force_->step({.twin = cycle_.state().rendering.twin,
                       .w_H = now.record.robot.w_H,
                       .change = input.change,
                       .time_s = time_s,
                       .is_running = now.record.mode == Mode::kRunning,
                       .is_clutch_open = input.is_clutch_open},
                      input.twin_force, now.teleoperation);
  }
  if (twin_base_ != nullptr) {
    const CycleRecord& last = now.record;
    input.twin_base =
        twin_base_->step(last.mode == Mode::kRunning, last.refusal == Refusal::kTwinApart);
  }
  next_.request = ModeRequest::kNone;
  next_.late_cycles = 0;

  device_.read(now.sensors);
  const Truth* truth = device_.truth();
  now.truth = truth != nullptr ? *truth : Truth{};
}

void Session::step() noexcept HG_NONBLOCKING {
  cycle_.step(sample_->sensors, sample_->operator_input, sample_->command, sample_->record);
}

void Session::request(ModeRequest request) noexcept {
  is_operated_ = is_operated_ || takes_over(request);
  is_asked_ = true;
  next_.request = request;
}

bool Session::is_over() const noexcept {
  const Mode mode = record().mode;
  return mode == Mode::kFault ||
         (is_stopping_ && mode != Mode::kRunning && mode != Mode::kStopping);
}

}  // namespace hg::runtime
