#include "hg/analysis/run_news.h"

#include <fmt/format.h>

#include <utility>

#include "hg/controller/safety/rules.h"

namespace hg::analysis {
namespace {

// Once its drives are on, a device outside of a limit moves back; whoever is near must know before.
std::vector<News> outside_of_limits(const CycleRecord& record, const LimitCatalogue& limits) {
  constexpr double kWorthALine = 0.02;  // rad or m
  std::vector<News> news;
  for (int i = 0; i < record.limit_count && i < static_cast<int>(limits.size()); ++i) {
    const LimitInfo& limit = limits[i];
    const bool is_place = limit.kind == LimitKind::kManipulatorJoint ||
                          limit.kind == LimitKind::kVirtualJoint ||
                          limit.kind == LimitKind::kCartesian;
    if (!is_place || !(record.limits[i].excess > kWorthALine)) continue;
    news.push_back(
        {"outside",
         fmt::format("{} stands {:.0f} {} outside of its range of {:g} to {:g} {}: once the "
                     "drives are on, it moves back slowly without a hand; keep clear, or "
                     "move it back by the arm's own controls, or widen the range",
                     limit.name, 1e3 * record.limits[i].excess, limit.is_angle ? "mrad" : "mm",
                     limit.range.lb, limit.range.ub, limit.is_angle ? "rad" : "m")});
  }
  return news;
}

}  // namespace

// Text about a drift of the force sensor's zero that has settled, and about one that cannot be
// taken off; empty: nothing new.
std::string RunNews::drift(const CycleRecord& record) {
  constexpr double kForce = 0.25, kTorque = 0.025;  // N, Nm
  constexpr double kShare = 0.5;                    // of what was reported last
  constexpr double kSettled = 1e-3;                 // N and Nm in a sample
  constexpr double kLeft = 1.0, kLowPass = 5e-4;    // N, share of a sample
  const RestReport& rest = record.rest;
  left_ =
      rest.is_untouched ? Vector6(left_ + kLowPass * (record.robot.w_H - left_)) : Vector6::Zero();
  const bool has_settled = (std::exchange(zero_, rest.zero) - rest.zero).norm() < kSettled;
  const Vector6 change = rest.zero - reported_zero_;
  const bool is_large =
      change.head<3>().norm() > kForce + kShare * reported_zero_.head<3>().norm() ||
      change.tail<3>().norm() > kTorque + kShare * reported_zero_.tail<3>().norm();
  const bool is_taken = rest.is_untouched && has_settled && is_large;
  const bool is_left =
      !is_taken && has_settled && left_.head<3>().norm() > kLeft && !is_left_reported_;
  if (!is_taken && !is_left) return {};
  if (is_taken) reported_zero_ = rest.zero;
  is_left_reported_ = is_left_reported_ || is_left;
  const Vector6& off = is_taken ? rest.zero : left_;
  return fmt::format(
      "the force sensor is off by {:.2g} N and {:.2g} Nm while the handle is free{}; tare "
      "it, or, where the tool has turned since the tare, find its weight from several poses: "
      "'hapticgiant identify payload'",
      off.head<3>().norm(), off.tail<3>().norm(), is_taken ? ": taken off" : "");
}

std::vector<News> RunNews::observe(const Sample& sample) {
  const CycleRecord& record = sample.record;
  std::vector<News> news;
  const bool waits = record.mode == Mode::kReady;
  if (!std::exchange(has_waited_, waits) && waits) news = outside_of_limits(record, names_.limits);
  const bool has_ended = record.tare != TareStatus::kNone && record.tare != TareStatus::kUnderWay;
  if (has_ended && std::exchange(tare_, record.tare) != record.tare) {
    news.push_back({"tare", std::string(to_string(record.tare))});
  }
  const std::string drifted = drift(record);
  if (!drifted.empty()) news.push_back({"zero", drifted});
  if (record.refusal != Refusal::kNone) {
    news.push_back({"request", std::string(to_string(record.refusal))});
  }
  if (!std::exchange(is_touched_, record.touch.is_reported) && record.touch.is_reported) {
    const int joint = record.touch.joint;
    const std::string where =
        joint < 0 ? "" : " beyond joint " + name_in(names_.joints, joint, "number");
    news.push_back({"contact", "something touches the arm" + where + ": it gives way"});
  }
  const FaultCode code = record.fault.code;
  if (std::exchange(fault_, code) != code && code != FaultCode::kNone) {
    news.push_back({safety::is_fault(code) ? "fault" : "stopped",
                    std::to_string(static_cast<int>(code)) + " " + std::string(to_string(code))});
  }
  return news;
}

}  // namespace hg::analysis
