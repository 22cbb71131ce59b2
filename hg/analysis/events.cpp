#include "hg/analysis/events.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hg::analysis {
namespace {

// [HANDBOOK] 10: a limit is hit within 2 mm / 5 mrad of it
constexpr double kNearMetres = 2e-3;
constexpr double kNearRadians = 5e-3;

// [HANDBOOK] 5.3: a checkpoint is reached
constexpr double kThereMetres = 0.10;
constexpr double kThereRadians = 15.0 * std::numbers::pi / 180.0;

bool is_at(const Pose& T_B_H, const Eigen::Vector3d& place) noexcept {
  const double azimuth = std::atan2(T_B_H.R(1, 2), T_B_H.R(0, 2));
  return (T_B_H.p - place).head<2>().norm() < kThereMetres &&
         std::abs(std::remainder(azimuth - place.z(), 2.0 * std::numbers::pi)) < kThereRadians;
}

bool is_held(LimitCause cause) noexcept {
  return cause == LimitCause::kLock || cause == LimitCause::kLatch ||
         cause == LimitCause::kFriction;
}

// the side of the position limit that is reached and acts, kInactive if none
LimitState reached_side(const LimitInfo& info, const LimitReport& report) noexcept {
  if (report.state == LimitState::kInactive || is_held(report.cause)) return LimitState::kInactive;
  const double near = info.is_angle ? kNearRadians : kNearMetres;
  if (report.state != LimitState::kUpper && report.to_lower <= near) return LimitState::kLower;
  if (report.state != LimitState::kLower && report.to_upper <= near) return LimitState::kUpper;
  return LimitState::kInactive;
}

using Situation = EventDetector::Situation;

Situation situation_of(const LimitInfo& info, const LimitReport& report) noexcept {
  if (report.cause == LimitCause::kLock) return Situation::kLocked;
  switch (reached_side(info, report)) {
    case LimitState::kLower:
      return Situation::kAtLower;
    case LimitState::kUpper:
      return Situation::kAtUpper;
    case LimitState::kInactive:
    case LimitState::kViolated:
      return Situation::kFree;
  }
  return Situation::kFree;
}

// A limit that is pressed with a changing force is reached once: it is left where the quantity has
// moved away from it.
Situation settled(Situation before, Situation now, const LimitInfo& info,
                  const LimitReport& report) noexcept {
  if (now != Situation::kFree) return now;
  const double gone = 2.0 * (info.is_angle ? kNearRadians : kNearMetres);
  const bool is_still_there = (before == Situation::kAtLower && report.to_lower <= gone) ||
                              (before == Situation::kAtUpper && report.to_upper <= gone);
  return is_still_there ? before : now;
}

// empty = not reported
const char* event_text(Situation before, Situation now) noexcept {
  if (before == Situation::kLocked) return "unlocked";
  switch (now) {
    case Situation::kAtLower:
      return "lower limit reached";
    case Situation::kAtUpper:
      return "upper limit reached";
    case Situation::kLocked:
      return "locked";
    case Situation::kFree:
      return "";
  }
  return "";
}

}  // namespace

EventDetector::EventDetector(std::vector<EventRule> rules, LimitCatalogue catalogue)
    : rules_(std::move(rules)), catalogue_(std::move(catalogue)) {}

bool EventDetector::holds(const Condition& condition, const CycleRecord& record) const {
  const std::size_t i = condition.index;
  switch (condition.kind) {
    case ConditionKind::kLimit: {
      const LimitState side = reached_side(catalogue_[i], record.limits[i]);
      return side != LimitState::kInactive &&
             (condition.side == LimitState::kInactive || condition.side == side);
    }
    case ConditionKind::kSpeedLimit: {
      const LimitReport& limit = record.limits[i];
      return limit.state != LimitState::kInactive && limit.cause == LimitCause::kVelocity &&
             (condition.side == LimitState::kInactive || condition.side == limit.state);
    }
    case ConditionKind::kLocked:
      return record.limits[i].cause == LimitCause::kLock;
    case ConditionKind::kForceAbove:
      return record.robot.w_H.head<3>().norm() > condition.value;
    case ConditionKind::kForceBelow:
      return record.robot.w_H.head<3>().norm() < condition.value;
    case ConditionKind::kTwinAbove:
      return record.twin.q_a[condition.index] > condition.value;
    case ConditionKind::kTwinBelow:
      return record.twin.q_a[condition.index] < condition.value;
    case ConditionKind::kTurns: {
      const double angle = record.reference.q_m[condition.index] - q_m_start_[condition.index];
      return std::copysign(1.0, condition.value) * angle >=
             2.0 * std::numbers::pi * std::abs(condition.value);
    }
    case ConditionKind::kGantryAbove:
      return record.robot.q_p[condition.index] > condition.value;
    case ConditionKind::kGantryBelow:
      return record.robot.q_p[condition.index] < condition.value;
    case ConditionKind::kElapsed:
      return record.time_s - start_s_ > condition.value;
    case ConditionKind::kHandleAt:
      return is_at(record.T_B_H, condition.place);
    case ConditionKind::kSurface:
      return record.contact.surface == condition.index;
  }
  return false;
}

std::optional<RunEvent> EventDetector::observe(const CycleRecord& record) {
  if (record.mode != Mode::kRunning) return std::nullopt;
  if (q_m_start_.size() == 0) {
    q_m_start_ = record.reference.q_m;
    start_s_ = record.time_s;
  }

  if (!rules_.empty()) {
    if (next_ == rules_.size()) return std::nullopt;
    const EventRule& rule = rules_[next_];
    const bool happens = std::all_of(rule.all_of.begin(), rule.all_of.end(),
                                     [&](const Condition& c) { return holds(c, record); });
    if (!happens) return std::nullopt;
    ++next_;
    return RunEvent{rule.name, record.time_s, rule.what};
  }

  return observe_limits(record);
}

// One event per record; what happens at the same time follows with the next records.
std::optional<RunEvent> EventDetector::observe_limits(const CycleRecord& record) {
  const bool is_first = situations_.empty();
  situations_.resize(catalogue_.size(), Situation::kFree);
  for (std::size_t i = 0; i < catalogue_.size(); ++i) {
    const Situation before = situations_[i];
    const Situation now = settled(before, situation_of(catalogue_[i], record.limits[i]),
                                  catalogue_[i], record.limits[i]);
    situations_[i] = now;
    if (is_first || now == before) continue;
    const char* what = event_text(before, now);
    if (what[0] != '\0') return RunEvent{catalogue_[i].name, record.time_s, what};
  }
  return std::nullopt;
}

std::vector<std::string> EventDetector::missing() const {
  std::vector<std::string> names;
  for (std::size_t i = next_; i < rules_.size(); ++i) names.push_back(rules_[i].name);
  return names;
}

}  // namespace hg::analysis
