#include "apps/hapticgiant/run_recording.h"

#include <fmt/format.h>

#include <utility>

#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/run_setup.h"
#include "hg/controller/safety/rules.h"

namespace hg::apps {
namespace {

constexpr double kAfterFault_s = 2.0;  // belong to it: how the device came to rest

}  // namespace

RunRecording::RunRecording(const config::Scenario& scenario, const RunArguments& arguments)
    : is_fast_(arguments.is_fast),
      writes_always_(arguments.flight_recorder == "always"),
      program_(arguments.program) {
  if (!recording::recording_available()) {
    if (arguments.has_recording) print_out(kNoRecording);
    return;
  }
  const recording::RecordingInfo info = recording_info(scenario, arguments);
  if (arguments.has_recording) recorder_ = std::make_unique<recording::Recorder>(info);
  if (arguments.flight_recorder != "off") {
    flight_ = std::make_unique<recording::FlightRecorder>(info);
  }
}

void RunRecording::push(const Sample& sample) {
  if (recorder_ && is_fast_) recorder_->push_waiting(sample);
  if (recorder_ && !is_fast_) recorder_->push(sample);
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

std::string RunRecording::news() {
  if (!recorder_ || has_told_) return {};
  const std::string error = recorder_->error();
  has_told_ = !error.empty();
  return error;
}

RunRecording::Result RunRecording::close() {
  Result result;
  if (recorder_) close_recorder(result);
  // the last seconds stand in for a recording that has none
  const bool is_wanted = writes_always_ || !result.error.empty();
  if (flight_ && cause_.empty() && is_wanted) cause_ = "stop";
  if (flight_) close_flight(result);
  return result;
}

void RunRecording::close_recorder(Result& result) {
  const recording::RecordingSummary recorded = recorder_->close();
  if (!recorded.error.empty()) {
    print_error("recording ended early: {}\n", recorded.error);
    result.is_whole = false;
  }
  if (!recorded.not_renamed.empty()) {
    print_error("the recording is complete, but keeps its name {}: {}\n", recorded.file.string(),
                recorded.not_renamed);
    result.is_whole = false;
  }
  if (!recorded.not_linked.empty()) print_out("recording   {}\n", recorded.not_linked);
  for (const auto& name : recorded.deleted) {
    print_out("recording {} deleted to keep within the disk budget\n", name);
  }
  result.file = recorded.file.string();
  result.unrecorded = recorded.dropped;
  result.error = recorded.error;
  recorder_.reset();
}

void RunRecording::close_flight(Result& result) {
  if (!cause_.empty()) flight_->write(std::exchange(cause_, ""));
  const recording::FlightRecorder::Result kept = flight_->close();
  for (const auto& written : kept.files) {
    print_out("the last seconds are kept; what happened:\n  {} explain {}\n", program_,
              written.string());
  }
  if (!kept.error.empty()) {
    print_error("the last seconds could not be written: {}\n", kept.error);
    result.is_whole = false;
  }
  flight_.reset();
}

}  // namespace hg::apps
