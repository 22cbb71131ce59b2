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

std::vector<News> RunNews::observe(const Sample& sample) {
  const CycleRecord& record = sample.record;
  std::vector<News> news;
  const bool waits = record.mode == Mode::kReady;
  if (!std::exchange(has_waited_, waits) && waits) news = outside_of_limits(record, names_.limits);
  const bool has_ended = record.tare != TareStatus::kNone && record.tare != TareStatus::kUnderWay;
  if (has_ended && std::exchange(tare_, record.tare) != record.tare) {
    news.push_back({"tare", std::string(to_string(record.tare))});
  }
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
