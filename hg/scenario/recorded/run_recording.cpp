#include "hg/scenario/recorded/run_recording.h"

#include <fmt/format.h>

#include <utility>

#include "hg/controller/safety/rules.h"

namespace hg::scenario {
namespace {

constexpr double kAfterFault_s = 2.0;  // belong to it: how the device came to rest

}  // namespace

RunRecording::RunRecording(const RecordingPlan& plan)
    : is_always_(plan.is_always), is_waiting_(plan.is_waiting) {
  if (!recording::recording_available()) return;
  if (plan.has_recording) recorder_ = std::make_unique<recording::Recorder>(plan.info);
  if (plan.has_last_seconds) flight_ = std::make_unique<recording::FlightRecorder>(plan.info);
}

void RunRecording::push(const Sample& sample) {
  if (recorder_ && is_waiting_) recorder_->push_waiting(sample);
  if (recorder_ && !is_waiting_) recorder_->push(sample);
  if (flight_) keep_last_seconds(sample);
}

void RunRecording::keep_last_seconds(const Sample& sample) {
  const CycleRecord& record = sample.record;
  flight_->push(sample);
  if (!cause_.empty() && record.time_s >= write_at_s_) flight_->write(std::exchange(cause_, ""));
  const FaultCode last = std::exchange(fault_, record.fault.code);
  if (!safety::is_fault(fault_) || fault_ == last) return;
  // what follows from the first fault belongs to it
  if (cause_.empty()) cause_ = fmt::format("fault{}", static_cast<int>(fault_));
  write_at_s_ = record.time_s + kAfterFault_s;
}

void RunRecording::event(double time_s, std::string_view name, std::string_view text) {
  if (recorder_) recorder_->event(time_s, name, text);
  if (flight_) flight_->event(time_s, name, text);
}

void RunRecording::lab_clock(const recording::LabClock& clock) {
  if (recorder_) recorder_->lab_clock(clock);
  if (flight_) flight_->lab_clock(clock);
}

std::string RunRecording::news() {
  if (!recorder_ || has_reported_) return {};
  const std::string error = recorder_->error();
  has_reported_ = !error.empty();
  return error;
}

RunRecording::Result RunRecording::close() {
  Result result;
  if (recorder_) result.recording = recorder_->close();
  // the last seconds stand in for a recording that has none
  const bool is_wanted = is_always_ || !result.recording.error.empty();
  if (cause_.empty() && is_wanted) cause_ = "stop";
  if (flight_ && !cause_.empty()) flight_->write(std::exchange(cause_, ""));
  if (flight_) result.last_seconds = flight_->close();
  recorder_.reset();
  flight_.reset();
  return result;
}

bool RunRecording::Result::is_whole() const {
  return recording.error.empty() && recording.not_renamed.empty() && last_seconds.error.empty();
}

}  // namespace hg::scenario
