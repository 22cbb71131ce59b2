#include "hg/viewer_server/limit_text.h"

#include <cmath>
#include <cstdio>
#include <string_view>

namespace hg::viewer_server {
namespace {

// Two significant digits below 10, whole numbers above.
std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) < 9.95 ? "%.2g" : "%.0f", value);
  return text;
}

std::string side(LimitState state, std::string_view what) {
  switch (state) {
    case LimitState::kLower:
      return "lower " + std::string(what);
    case LimitState::kUpper:
      return "upper " + std::string(what);
    case LimitState::kInactive:
    case LimitState::kViolated:
      break;
  }
  return std::string(what);
}

std::string reason(const LimitReport& report) {
  switch (report.cause) {
    case LimitCause::kVelocity:
      return "speed limit";
    case LimitCause::kAcceleration:
      return "acceleration limit";
    case LimitCause::kLock:
      return "locked";
    case LimitCause::kLatch:
      return "latched";
    case LimitCause::kFriction:
      return "held by friction";
    case LimitCause::kContradiction:
      return "limits contradict each other";
    case LimitCause::kTorque:
      return "all its torque";
    case LimitCause::kTorqueRate:
      return "its torque is building up";
    case LimitCause::kWeight:
      return "carries its share of the arm's weight";
    case LimitCause::kBraking:
      return "slower here, at this speed it could not stop before its end";
    case LimitCause::kNone:
    case LimitCause::kPosition:
      break;
  }
  return side(report.state, "limit");
}

}  // namespace

std::string limit_text(const LimitInfo& info, const LimitReport& report) {
  std::string text = info.name + ": " + reason(report);
  if (report.state == LimitState::kViolated && report.excess > 0.0) {
    return text + ", exceeded by " + number(1e3 * report.excess) +
           (info.is_angle ? " mrad" : " mm");
  }
  return text + ", " + number(std::abs(report.reaction)) + (info.is_angle ? " Nm" : " N");
}

std::string mode_text(const CycleRecord& record) {
  switch (record.mode) {
    case Mode::kOff:
      return "off: waiting for the device";
    case Mode::kReady:
      if (record.refusal != Refusal::kNone)
        return "ready: " + std::string(to_string(record.refusal));
      if (record.is_tared) return "ready: about to arm";
      if (record.tare == TareStatus::kUnderWay) return "ready: the force sensor is being tared";
      return "ready: the force sensor needs a tare, " + std::string(to_string(record.tare));
    case Mode::kArmed:
      return "armed: starts when the hand closes the dead-man switch";
    case Mode::kRunning:
      return "running: the hand holds the dead-man switch";
    case Mode::kStopping:
      return "stopping: requested, or the hand has let go";
    case Mode::kFault:
      return "fault: " + std::string(to_string(record.fault.code));
  }
  return {};
}

}  // namespace hg::viewer_server
