#include "hg/runtime/requests.h"

namespace hg::runtime {
namespace {

constexpr std::uint64_t kPatience = 1000;  // cycles

// While the latency is unknown, arming is requested for one cycle in kPatience: its refusal reports
// the cause.
ModeRequest arm_request(const CycleRecord& record) noexcept {
  const bool is_due = record.is_latency_known || (record.cycle + 1) % kPatience == 0;
  return is_due ? ModeRequest::kArm : ModeRequest::kNone;
}

ModeRequest ready_request(const CycleRecord& record, bool is_held) noexcept {
  if (record.tare == TareStatus::kUnderWay) return ModeRequest::kNone;
  if (record.is_tared) return arm_request(record);
  const bool is_hopeless = record.tare == TareStatus::kRefusedHeld && is_held;
  return is_hopeless ? ModeRequest::kNone : ModeRequest::kTare;
}

}  // namespace

ModeRequest next_request(const CycleRecord& record, bool is_held, bool is_stopping) noexcept {
  switch (record.mode) {
    case Mode::kReady:
      return ready_request(record, is_held);
    case Mode::kArmed:
      return is_held && !is_stopping ? ModeRequest::kRun : ModeRequest::kNone;
    case Mode::kRunning:
      return is_stopping ? ModeRequest::kStop : ModeRequest::kNone;
    case Mode::kOff:
    case Mode::kStopping:
    case Mode::kFault:
      return ModeRequest::kNone;
  }
  return ModeRequest::kNone;
}

}  // namespace hg::runtime
